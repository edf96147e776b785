// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

namespace grouser::output {

inline constexpr const char* kUntilRest = "--until rest"; ///< `ended_by` of a run that stopped before the drive

/// Status of a run in its manifest and in the summary of a sweep.
enum class RunStatus {
  pending, ///< run of a sweep that has not started
  running,
  finished,
  incomplete, ///< ended, but the vehicle never drove, or drove too little for valid figures
  failed,
  stopped ///< stopped by a signal; can be resumed
};

/// Whether a run has ended without an error.
constexpr bool hasEnded(RunStatus status) { return status == RunStatus::finished || status == RunStatus::incomplete; }

} // namespace grouser::output

template <> struct grouser::base::EnumWords<grouser::output::RunStatus> {
  using E = output::RunStatus;
  static constexpr EnumWord<E> list[] = {{E::pending, "pending"},   {E::running, "running"},
                                         {E::finished, "finished"}, {E::incomplete, "incomplete"},
                                         {E::failed, "failed"},     {E::stopped, "stopped"}};
};

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace grouser::studies {

/// `grouser study multibody`.
struct StudyCommand {
  std::vector<std::string> cases; ///< empty: all
  bool stability = false;         ///< only which steps are stable
  bool quick = false;             ///< few steps of a few cases, in seconds
  double budget = 60;             ///< [s] of CPU for one run
  std::string folder;             ///< empty: out/study_multibody
  bool force = false;
};
void studyMultibodyCommand(const StudyCommand& command);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/studies/vehicle_trial.hpp"

#include <array>
#include <string>
#include <vector>

/// The verdict on a run of a stability map: against the same scene at a quarter of the step.
namespace grouser::studies {

enum class MapVerdict {
  sound,         ///< ends, and so does the finer run, with figures alike
  stopped,       ///< by a guard, for a cause that the finer run confirms
  wrongCause,    ///< by a guard, for a cause that the finer run does not show
  silentlyWrong, ///< ends as if sound, and the finer run says otherwise
  refused        ///< before the run
};
inline constexpr std::array<const char*, 5> kVerdictWords{"sound", "stopped", "wrong cause", "silently wrong",
                                                          "refused"};

struct Judgement {
  MapVerdict verdict = MapVerdict::sound;
  std::string why; ///< the message of the guard or of the refusal; for the rest what differs, and by how much
};

/// A figure that is compared, and what it may differ by: `relative` of the larger of both, and `floor` in its unit.
struct ComparedFigure {
  const char* name;
  const char* unit;
  double MapFigures::*value;
  double relative, floor;
};
/// On rigid ground, where a run is the same motion at both steps; on a bed, where grains fall into other places.
const std::vector<ComparedFigure>& comparedFigures(bool onBed);

/// Left over of the books, of the turnover, that is rounding [-].
inline constexpr double kMostLeftOver = 1e-8;

/// What a guard's message is about, and whether it says that the step is to blame.
struct Blame {
  std::string kind;
  bool step = false;
};
Blame blameOf(const std::string& message);

Judgement judge(const VehicleTrial& run, const VehicleTrial& finer, bool onBed);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/vehicle_trial.hpp"

#include <array>
#include <string>
#include <vector>

/// The verdict on a run of a stability map: against the same scene at a quarter of the step, and where figures of the
/// two disagree against runs at neighbouring steps, which tell an error of the step from scatter.
namespace grouser::studies {

enum class MapVerdict {
  sound,         ///< ends, and so does the finer run, with figures alike
  stopped,       ///< by a guard, for a cause that the finer run confirms
  wrongCause,    ///< by a guard, for a cause that the finer run does not show
  silentlyWrong, ///< ends as if sound, and the finer run says otherwise
  scatters,      ///< figures differ, and no more than those of runs at neighbouring steps do: a chaotic motion
  warned,        ///< ends with a warning of blows, and figures differ by more than that
  refused        ///< before the run
};
inline constexpr std::array<const char*, 7> kVerdictWords{"sound",    "stopped", "wrong cause", "silently wrong",
                                                          "scatters", "warned",  "refused"};

struct Judgement {
  MapVerdict verdict = MapVerdict::sound;
  std::string why; ///< the message of the guard or of the refusal; for the rest what differs, and by how much
};

/// A figure that is compared, and what it may differ by: `relative` of the larger of both, and `floor` in its unit. One
/// that may change its sign within the window is a small difference of large ones then: its mean magnitude counts.
struct ComparedFigure {
  const char* name;
  const char* unit;
  double MapFigures::*value;
  double relative, floor;
  double MapFigures::*magnitude = nullptr;
};
/// On rigid ground, where a run is the same motion at both steps; on a bed, where grains fall into other places.
const std::vector<ComparedFigure>& comparedFigures(bool onBed);

/// Left over of the books, of the turnover, that is rounding [-].
inline constexpr double kMostLeftOver = 1e-8;

/// Whether a shorter time step avoids failures of this cause.
bool blamesStep(base::Cause cause);

/// The run that judges has so many times as many steps.
inline constexpr double kFinerRatio = 4;

/// A run, and the same at a quarter of its step.
struct TrialPair {
  VehicleTrial run, finer;
};

/// Of the pair alone.
Judgement judge(const VehicleTrial& run, const VehicleTrial& finer, bool onBed);

/// Whether that judgement is for figures alone, of runs that are sound otherwise: what scatter may explain.
bool figuresDisagree(const VehicleTrial& run, const VehicleTrial& finer, bool onBed);

/// Steps beside each of a pair's, as shares of it [-]: too near for a figure to change with the step, and another way
/// through for a motion that is chaotic.
inline constexpr std::array<double, 5> kNeighbourShares{0.995, 0.99, 0.985, 0.98, 0.975};
/// 95 % point of Fisher's distribution of 4 and 4 degrees of freedom: of two variances, each of five runs.
inline constexpr double kFisher95 = 6.388;

/// Of a pair whose figures disagree, the first, and of pairs at neighbouring steps. Silently wrong where one of these
/// is not sound; where the means of a figure over the neighbours differ by more than it may and by more than Welch's 95
/// % interval of their difference; or where it scatters more widely at the steps than at the quarters, by Fisher's
/// test, and more than it may differ. Else it scatters. The first pair is not counted: it is looked into for lying
/// apart. Warned instead of silently wrong where all are sound and the run warns of blows (vehicle::BlowMeter).
Judgement judge(const std::vector<TrialPair>& pairs, bool onBed);

/// A line a compared figure: mean and standard deviation at the neighbouring steps, the same at their quarters, the
/// difference of the means with its interval, and what it may differ by.
std::string scatterTable(const std::vector<TrialPair>& pairs, bool onBed);

} // namespace grouser::studies

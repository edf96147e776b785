// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/vehicle_trial.hpp"

#include <array>
#include <string>
#include <vector>

/// The verdict on a run of a stability map. The run is compared with a run of the same scene at a quarter of the step.
/// If figures of these runs disagree, runs at neighbouring steps distinguish errors of the step from scatter.
namespace grouser::studies {

enum class MapVerdict {
  sound,         ///< both runs end normally; their figures agree
  stopped,       ///< a guard stopped the run, and the finer run confirms the cause
  wrongCause,    ///< a guard stopped the run, but the finer run does not confirm the cause
  silentlyWrong, ///< the run ends normally, but the finer run contradicts it
  scatters,      ///< the figures differ within the scatter of neighbouring steps: chaotic motion
  warned,        ///< the run ends with a warning about impacts, and figures differ by more than the scatter
  refused        ///< the program rejected the scene before the run
};
inline constexpr std::array<const char*, 7> kVerdictWords{"sound",    "stopped", "wrong cause", "silently wrong",
                                                          "scatters", "warned",  "refused"};

struct Judgement {
  MapVerdict verdict = MapVerdict::sound;
  std::string why; ///< message of the guard or of the rejection; otherwise the difference
};

/// A compared figure and its allowed difference: `relative` times the larger value, plus `floor` in the unit of the
/// figure. For figures that may change sign within the window, the value is their mean magnitude.
struct ComparedFigure {
  const char* name;
  const char* unit;
  double MapFigures::*value;
  double relative, floor;
  double MapFigures::*magnitude = nullptr;
};
/// Tolerances on rigid ground (both steps have the same motion) and on a bed (the grain positions differ).
const std::vector<ComparedFigure>& comparedFigures(bool onBed);

/// Maximum energy residual / turnover that counts as rounding [-].
inline constexpr double kMaxResidual = 1e-8;

/// True if a shorter time step avoids failures with this cause.
bool blamesStep(base::Cause cause);

/// Step of the run / step of the finer run.
inline constexpr double kFinerRatio = 4;

/// A run, and a run of the same scene at a quarter of its step.
struct TrialPair {
  VehicleTrial run, finer;
};

/// Verdict from one pair of runs.
Judgement judge(const VehicleTrial& run, const VehicleTrial& finer, bool onBed);

/// True if both runs are sound except for a difference between their figures, which scatter may explain.
bool figuresDisagree(const VehicleTrial& run, const VehicleTrial& finer, bool onBed);

/// Neighbouring step / step [-]: too close to 1 for a systematic change, but chaotic motions differ.
inline constexpr std::array<double, 5> kNeighbourShares{0.995, 0.99, 0.985, 0.98, 0.975};
/// 95 % quantile of Fisher's distribution with 4 and 4 degrees of freedom, for the variances of two sets of five runs.
inline constexpr double kFisher95 = 6.388;

/// Verdict from a first pair with figures that disagree, and from pairs at neighbouring steps. `silentlyWrong` if a run
/// at a neighbouring step is not sound; if the means of a figure over the neighbours differ by more than allowed and by
/// more than Welch's 95 % interval; or if the scatter at the steps exceeds the scatter at the quarters (Fisher's test)
/// and the allowed difference. Otherwise `scatters`. Means and scatter exclude the first pair (selection bias).
/// `warned` replaces `silentlyWrong` if all runs are sound and the run warns about impacts (vehicle::BlowMeter).
Judgement judge(const std::vector<TrialPair>& pairs, bool onBed);

/// One line per figure: mean and standard deviation at the neighbouring steps and at their quarters, difference of the
/// means with its interval, allowed difference.
std::string scatterTable(const std::vector<TrialPair>& pairs, bool onBed);

} // namespace grouser::studies

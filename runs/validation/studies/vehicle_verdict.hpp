// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/vehicle_trial.hpp"

#include <array>
#include <string>
#include <vector>

/// The verdict on a run of a stability map: comparison with the same scene at a quarter of the step, and if figures
/// disagree with runs at neighbouring steps, to distinguish errors of the step from scatter.
namespace grouser::studies {

enum class MapVerdict {
  sound,         ///< both runs end normally with equal figures
  stopped,       ///< stopped by a guard, confirmed by the finer run
  wrongCause,    ///< stopped by a guard, not confirmed by the finer run
  silentlyWrong, ///< ends normally, contradicted by the finer run
  scatters,      ///< figures differ within the scatter of neighbouring steps: chaotic motion
  warned,        ///< ends with a warning about impacts, figures differ by more than the scatter
  refused        ///< rejected before the run
};
inline constexpr std::array<const char*, 7> kVerdictWords{"sound",    "stopped", "wrong cause", "silently wrong",
                                                          "scatters", "warned",  "refused"};

struct Judgement {
  MapVerdict verdict = MapVerdict::sound;
  std::string why; ///< message of the guard or rejection; else the difference
};

/// A compared figure and its allowed difference: `relative` of the larger value, and `floor` in its unit. Figures that
/// may change sign within the window are scaled by their mean magnitude.
struct ComparedFigure {
  const char* name;
  const char* unit;
  double MapFigures::*value;
  double relative, floor;
  double MapFigures::*magnitude = nullptr;
};
/// Tolerances on rigid ground (same motion at both steps) and on a bed (different grain positions).
const std::vector<ComparedFigure>& comparedFigures(bool onBed);

/// Maximum energy residual / turnover that counts as rounding [-].
inline constexpr double kMaxResidual = 1e-8;

/// Whether a shorter time step avoids failures of this cause.
bool blamesStep(base::Cause cause);

/// Ratio of the steps of both runs.
inline constexpr double kFinerRatio = 4;

/// A run, and the same scene at a quarter of its step.
struct TrialPair {
  VehicleTrial run, finer;
};

/// Verdict from the pair only.
Judgement judge(const VehicleTrial& run, const VehicleTrial& finer, bool onBed);

/// Whether the verdict depends only on figures of otherwise sound runs, which scatter may explain.
bool figuresDisagree(const VehicleTrial& run, const VehicleTrial& finer, bool onBed);

/// Neighbouring steps as fractions of the step [-]: too close for a systematic change, but different for chaotic
/// motions.
inline constexpr std::array<double, 5> kNeighbourShares{0.995, 0.99, 0.985, 0.98, 0.975};
/// 95 % quantile of Fisher's distribution with 4 and 4 degrees of freedom: two variances of five runs each.
inline constexpr double kFisher95 = 6.388;

/// Verdict from a pair whose figures disagree (first) and pairs at neighbouring steps. Silently wrong if one of these
/// is not sound; if the means of a figure over the neighbours differ by more than allowed and by more than Welch's 95 %
/// interval; or if the scatter at the steps exceeds that at the quarters (Fisher's test) and the allowed difference.
/// Else `scatters`. The first pair is excluded (selection bias). `warned` instead of silently wrong if all are sound
/// and the run warns about impacts (vehicle::BlowMeter).
Judgement judge(const std::vector<TrialPair>& pairs, bool onBed);

/// One line per figure: mean and standard deviation at the neighbouring steps and at their quarters, difference between
/// the means with its interval, allowed difference.
std::string scatterTable(const std::vector<TrialPair>& pairs, bool onBed);

} // namespace grouser::studies

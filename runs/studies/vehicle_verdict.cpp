// SPDX-License-Identifier: BSD-3-Clause
#include "runs/studies/vehicle_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

const std::vector<ComparedFigure>& comparedFigures(bool onBed) {
  // A twentieth of what is measured, and a floor where that is small: a hundredth of the vehicle's walking pace, a
  // tenth of the arms' deflection under its weight, a hundredth of what it takes to drive, and of a strand's pull.
  static const std::vector<ComparedFigure> onRigidGround = {
      {"speed", "m/s", &MapFigures::speed, 0.05, 0.01},
      {"height", "m", &MapFigures::height, 0, 0.004},
      {"lowest height", "m", &MapFigures::lowest, 0, 0.01},
      {"pitch", "rad", &MapFigures::pitch, 0, 0.005},
      {"power", "W", &MapFigures::power, 0.05, 30},
      {"tension", "N", &MapFigures::tension, 0.05, 50},
      {"dissipated energy", "J", &MapFigures::dissipated, 0.1, 10}};
  // Grains at another step settle into another bed: two to four standard deviations of the difference of two beds from
  // other seeds, as the map `seeds` measures them (docs/vehicle_stability.md).
  static const std::vector<ComparedFigure> onGrains = {{"speed", "m/s", &MapFigures::speed, 0.2, 0.05},
                                                       {"sinkage", "m", &MapFigures::sinkage, 0.2, 0.01},
                                                       {"power", "W", &MapFigures::power, 0.3, 300},
                                                       {"tension", "N", &MapFigures::tension, 0.05, 300},
                                                       {"dissipated energy", "J", &MapFigures::dissipated, 0.2, 50}};
  return onBed ? onGrains : onRigidGround;
}

Blame blameOf(const std::string& message) {
  struct Known {
    const char *words, *kind;
    bool step;
  };
  static constexpr std::array<Known, 15> kKnown{{
      {"the step is not to blame", "a grain pressed through a part", false},
      {"while the", "a bed that does not settle", false},
      {"track thrown", "the track leaves its wheels", false},
      {"track skips", "the track leaves its wheels", false},
      {"left the terrain", "the terrain ends", false},
      {"come to rest", "no rest", false},
      {"tangential_damping_ratio", "tangential dashpots", false},
      {"contacts are unstable", "unstable contacts", true},
      {"too long for these contacts", "unstable contacts", true},
      {"turns by", "turns too far a step", true},
      {"swings across", "swings across the pull", true},
      {"within one step it has moved", "a part is thrown in a step", true},
      {"motion is too fast for dt", "too fast for the solver", true},
      {"neighbour list's skin in one step", "a grain too fast for its list", true},
      {"is no number", "no number", true},
  }};
  for (const Known& k : kKnown)
    if (message.find(k.words) != std::string::npos) return {k.kind, k.step};
  return {"other", false};
}

namespace {

/// What differs most beyond what it may; empty where nothing does.
std::string difference(const MapFigures& run, const MapFigures& finer, bool onBed) {
  for (const MapFigures* f : {&run, &finer})
    if (!(std::fabs(f->leftOver) <= kMostLeftOver))
      return fmt::format("the books leave {:.3g} of the turnover over", f->leftOver);
  std::string worst;
  double most = 1;
  for (const ComparedFigure& c : comparedFigures(onBed)) {
    const double a = run.*c.value, b = finer.*c.value;
    if (std::isnan(a) && std::isnan(b)) continue; // not to be had in this scene
    if (!std::isfinite(a) || !std::isfinite(b)) return fmt::format("{} is {} and {}: no number", c.name, a, b);
    const double may = c.relative * std::max(std::fabs(a), std::fabs(b)) + c.floor;
    const double over = std::fabs(a - b) / may;
    if (over <= most) continue;
    most = over;
    worst = fmt::format("{} is {:.4g} {}, at a quarter of the step {:.4g} {}: {:.3g} apart, more than {:.3g}", c.name,
                        a, c.unit, b, c.unit, std::fabs(a - b), may);
  }
  return worst;
}

} // namespace

Judgement judge(const VehicleTrial& run, const VehicleTrial& finer, bool onBed) {
  if (run.end == TrialEnd::refused) return {MapVerdict::refused, run.cause};
  if (run.end == TrialEnd::stopped) {
    const Blame blame = blameOf(run.cause);
    const bool same = finer.end == TrialEnd::stopped && blameOf(finer.cause).kind == blame.kind;
    // Where the step is to blame a shorter one goes on beyond, whatever it meets later; where it is not, that meets the
    // same.
    const bool beyond =
        finer.end == TrialEnd::sound || (finer.end == TrialEnd::stopped && !same && finer.reached > run.reached);
    const bool confirmed = blame.step ? beyond : same;
    return {confirmed ? MapVerdict::stopped : MapVerdict::wrongCause, run.cause};
  }
  if (finer.end != TrialEnd::sound) return {MapVerdict::silentlyWrong, "at a quarter of the step: " + finer.cause};
  const std::string differs = difference(run.figures, finer.figures, onBed);
  return {differs.empty() ? MapVerdict::sound : MapVerdict::silentlyWrong, differs};
}

} // namespace grouser::studies

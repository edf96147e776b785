// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/vehicle_verdict.hpp"

#include "runs/jobs/estimate.hpp"
#include "runs/jobs/study_place.hpp"
#include "vehicle/blow_meter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

const std::vector<ComparedFigure>& comparedFigures(bool onBed) {
  // Relative tolerances and absolute floors. The floors are 1/100 of a slow speed, 1/10 of the static arm deflection,
  // and 1/100 of the driving power and of the strand tension.
  static const std::vector<ComparedFigure> onRigidGround = {
      {"speed", "m/s", &MapFigures::speed, 0.05, 0.01, &MapFigures::speedMagnitude},
      {"height", "m", &MapFigures::height, 0, 0.004},
      {"lowest height", "m", &MapFigures::lowest, 0, 0.01},
      {"pitch", "rad", &MapFigures::pitch, 0, 0.005},
      {"power", "W", &MapFigures::power, 0.05, 30, &MapFigures::powerMagnitude},
      {"tension", "N", &MapFigures::tension, 0.05, 50},
      {"dissipated energy", "J", &MapFigures::dissipated, 0.1, 10}};
  // Beds differ between steps. Therefore the tolerances are two to four standard deviations of the difference between
  // two beds with different seeds, from the map `seeds` (docs/evidence/vehicle_stability.md).
  static const std::vector<ComparedFigure> onGrains = {
      {"speed", "m/s", &MapFigures::speed, 0.2, 0.05, &MapFigures::speedMagnitude},
      {"sinkage", "m", &MapFigures::sinkage, 0.2, 0.01},
      {"power", "W", &MapFigures::power, 0.3, 300, &MapFigures::powerMagnitude},
      {"tension", "N", &MapFigures::tension, 0.05, 300},
      {"dissipated energy", "J", &MapFigures::dissipated, 0.2, 50}};
  return onBed ? onGrains : onRigidGround;
}

bool blamesStep(base::Cause cause) {
  using base::Cause;
  constexpr Cause kOfTheStep[] = {Cause::unstableContacts, Cause::fastTurn,  Cause::growingSwings, Cause::thrownPart,
                                  Cause::fastMotion,       Cause::fastGrain, Cause::noNumber};
  return std::find(std::begin(kOfTheStep), std::end(kOfTheStep), cause) != std::end(kOfTheStep);
}

namespace {

/// Message if the energy balance does not close; empty if it does.
std::string openBooks(const MapFigures& f) {
  if (std::fabs(f.energyResidual) <= kMaxResidual) return {};
  return fmt::format("the energy residual is {:.3g} of the turnover", f.energyResidual);
}

double sizeOf(const ComparedFigure& c, const MapFigures& f) {
  const double value = std::fabs(f.*c.value);
  return c.magnitude ? std::fmax(value, f.*c.magnitude) : value;
}

double allowed(const ComparedFigure& c, double size, double finerSize) {
  return c.relative * std::max(size, finerSize) + c.floor;
}

/// Message about a figure that is not finite in one of the runs (unless it is NaN in both); empty if there is none.
std::string noNumber(const MapFigures& run, const MapFigures& finer, bool onBed) {
  for (const ComparedFigure& c : comparedFigures(onBed)) {
    const double a = run.*c.value, b = finer.*c.value;
    if (!(std::isnan(a) && std::isnan(b)) && (!std::isfinite(a) || !std::isfinite(b)))
      return fmt::format("{} is {}, and {} at a quarter of the step: not a finite number", c.name, a, b);
  }
  return {};
}

/// Message about the figure that exceeds its allowed difference most; empty if no figure exceeds it.
std::string apartInWords(const MapFigures& run, const MapFigures& finer, bool onBed) {
  std::string worst;
  double most = 1;
  for (const ComparedFigure& c : comparedFigures(onBed)) {
    const double a = run.*c.value, b = finer.*c.value;
    const double may = allowed(c, sizeOf(c, run), sizeOf(c, finer)), over = std::fabs(a - b) / may;
    if (!(over > most)) continue; // also if the figure is not available in this scene
    most = over;
    worst = fmt::format("{} is {:.4g} {}, but {:.4g} {} at a quarter of the step: difference {:.3g}, allowed {:.3g}",
                        c.name, a, c.unit, b, c.unit, std::fabs(a - b), may);
  }
  return worst;
}

/// Message about the first error in two runs, except differences between their figures; empty if there is no error.
std::string fault(const VehicleTrial& run, const VehicleTrial& finer, bool onBed) {
  if (finer.end != TrialEnd::sound) return fmt::format("at a quarter of the step: {}", finer.cause);
  for (const MapFigures* f : {&run.figures, &finer.figures})
    if (std::string open = openBooks(*f); !open.empty()) return open;
  return noNumber(run.figures, finer.figures, onBed);
}

/// A figure at neighbouring steps and at their quarters, excluding the first pair.
struct FigureScatter {
  std::vector<double> runs, finer;
  double deviation = 0, finerDeviation = 0; ///< standard deviations of the runs
  support::Estimate change;                 ///< mean at the quarters minus mean at the steps
  double mean = 0, finerMean = 0, may = 0;
};

FigureScatter scatterOf(const ComparedFigure& c, const std::vector<TrialPair>& pairs) {
  FigureScatter s;
  double size = 0, finerSize = 0; // means
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const MapFigures &run = pairs[i].run.figures, &finerRun = pairs[i].finer.figures;
    s.runs.push_back(run.*c.value), s.finer.push_back(finerRun.*c.value);
    size += sizeOf(c, run) / static_cast<double>(pairs.size() - 1);
    finerSize += sizeOf(c, finerRun) / static_cast<double>(pairs.size() - 1);
  }
  const jobs::MeanError m = jobs::meanOf(s.runs), finer = jobs::meanOf(s.finer);
  const double root = std::sqrt(static_cast<double>(s.runs.size()));
  s.mean = m.mean, s.finerMean = finer.mean;
  s.deviation = root * m.error, s.finerDeviation = root * finer.error;
  s.change = jobs::unpairedChange(s.runs, s.finer);
  s.may = allowed(c, size, finerSize);
  return s;
}

/// Message if neighbouring steps show that the step causes an error; empty if the difference may be scatter.
std::string errorOfStep(const ComparedFigure& c, const FigureScatter& s) {
  const double apart = std::fabs(s.change.value);
  if (apart > s.may && apart > s.change.halfWidth)
    return fmt::format(
        "the mean of {} is {:.4g} {} over {} steps within 2.5 %, but {:.4g} {} over their quarters: difference {:.3g}, "
        "allowed {:.3g}, explained by scatter {:.3g}",
        c.name, s.mean, c.unit, s.runs.size(), s.finerMean, c.unit, apart, s.may, s.change.halfWidth);
  if (s.deviation > s.may && s.deviation * s.deviation > kFisher95 * s.finerDeviation * s.finerDeviation)
    return fmt::format("{} scatters by {:.3g} {} over {} steps within 2.5 %, but by {:.3g} {} over their quarters: the "
                       "step causes this scatter",
                       c.name, s.deviation, c.unit, s.runs.size(), s.finerDeviation, c.unit);
  return {};
}

/// Treats skipping and thrown tracks as one cause: a skipping track is about to leave its wheels.
base::Cause kindOf(base::Cause cause) { return cause == base::Cause::skippingTrack ? base::Cause::thrownTrack : cause; }

} // namespace

Judgement judge(const VehicleTrial& run, const VehicleTrial& finer, bool onBed) {
  if (run.end == TrialEnd::refused) return {MapVerdict::refused, run.cause};
  if (run.end == TrialEnd::stopped) {
    const bool same = finer.end == TrialEnd::stopped && kindOf(finer.blamed) == kindOf(run.blamed);
    // If the step is the cause, a shorter step passes this point; if not, it fails in the same way.
    const bool beyond =
        finer.end == TrialEnd::sound || (finer.end == TrialEnd::stopped && !same && finer.reached > run.reached);
    const bool confirmed = blamesStep(run.blamed) ? beyond : same;
    return {confirmed ? MapVerdict::stopped : MapVerdict::wrongCause, run.cause};
  }
  std::string wrong = fault(run, finer, onBed);
  if (wrong.empty()) wrong = apartInWords(run.figures, finer.figures, onBed);
  return {wrong.empty() ? MapVerdict::sound : MapVerdict::silentlyWrong, wrong};
}

bool figuresDisagree(const VehicleTrial& run, const VehicleTrial& finer, bool onBed) {
  return run.end == TrialEnd::sound && fault(run, finer, onBed).empty() &&
         !apartInWords(run.figures, finer.figures, onBed).empty();
}

Judgement judge(const std::vector<TrialPair>& pairs, bool onBed) {
  const TrialPair& first = pairs.at(0);
  Judgement alone = judge(first.run, first.finer, onBed);
  if (pairs.size() < 2 || !figuresDisagree(first.run, first.finer, onBed)) return alone;
  for (const TrialPair& p : pairs) {
    std::string wrong = p.run.end == TrialEnd::sound ? fault(p.run, p.finer, onBed) : p.run.cause;
    if (!wrong.empty())
      return {MapVerdict::silentlyWrong,
              fmt::format("{}; at the neighbouring step {:.5g} s: {}", alone.why, p.run.step, wrong)};
  }
  for (const ComparedFigure& c : comparedFigures(onBed)) {
    if (!std::isfinite(first.run.figures.*c.value)) continue; // the figure is not available in this scene
    if (std::string wrong = errorOfStep(c, scatterOf(c, pairs)); !wrong.empty())
      return {first.run.figures.blow > vehicle::BlowMeter::kBlow ? MapVerdict::warned : MapVerdict::silentlyWrong,
              wrong};
  }
  return {MapVerdict::scatters, fmt::format("{}; within the scatter of neighbouring steps", alone.why)};
}

std::string scatterTable(const std::vector<TrialPair>& pairs, bool onBed) {
  std::string text;
  for (const ComparedFigure& c : comparedFigures(onBed)) {
    const FigureScatter s = scatterOf(c, pairs);
    if (!std::isfinite(s.mean)) continue;
    text += fmt::format("  {:<18} {:>9.4g} +- {:<9.3g} {:>9.4g} +- {:<9.3g} {:>10.3g} +- {:<9.3g} {:>9.3g} {}\n",
                        c.name, s.mean, s.deviation, s.finerMean, s.finerDeviation, s.change.value, s.change.halfWidth,
                        s.may, c.unit);
  }
  return text;
}

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/settling.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "terrain/bed_tops.hpp"
#include "terrain/grain_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace grouser::coupling {

namespace {

constexpr double kMinFriction = 1e-4, kMaxFriction = 2; // 0 would select a different contact law
constexpr double kPreparedPull = 1e-4;                  // factor of cohesion and adhesion [-]; 0 is a different law
constexpr double kClose = 0.002;                        // tolerance of porosities [-]
constexpr double kOff = 0.01;                           // tolerance of porosities beyond the ends of the bisection [-]
constexpr int kTrials = 10;
constexpr double kSteep = 1;          // slope of the floor [-] above which every bed slides, for any friction
constexpr double kStep = 4;           // [radii] smaller height differences are ignored
constexpr double kLookEvery = 0.02;   // [s] interval of the checks for rest
constexpr std::size_t kCalmLooks = 5; // number of successive checks at rest
constexpr double kStillPrepared = 10; // factor of the rest energy: with little friction grains keep rocking

/// Porosity of the small bed settled with this friction.
double porosityAt(const PreparationSetup& preparation, double friction, const base::Exec& exec,
                  const SettleProgress& progress) {
  LaidGround ground = layGround(*preparation.sample, exec);
  SettleReport report;
  settleWithFriction(*preparation.sample->grains->bed, *ground.grains, friction, progress, report);
  keepSurface(ground, exec);
  return structureOf(ground).porosity;
}

/// Advice for a bed on a floor that is too steep; empty if the slope is acceptable.
std::string steepnessText(const LaidGround& ground) {
  const terrain::HeightFieldBounds& floor = ground.rigid->bounds();
  if (!(floor.slope > kSteep) || floor.highest - floor.lowest < kStep * ground.grains->model().radius) return "";
  return fmt::format(
      "; first check the floor: it follows terrain.heightmap with slopes up to {:.3g} m/m, and grains slide off "
      "it: set terrain.floor = \"flat\", lower terrain.height_range or enlarge terrain.size",
      floor.slope);
}

/// Fills in the height of the bed.
void measureHeight(const LaidGround& ground, SettleReport& report) {
  const base::Exec& exec = ground.grains->system().exec;
  const terrain::Rectangle& w = *ground.walls;
  const terrain::BedSurface surface(exec, *ground.grains, ground.rigid->view(), w);
  report.meanHeight = terrain::heightsOf(extentOf(ground, surface)).mean;
  // Search radius about the corner nodes that covers the whole bed.
  const terrain::NodeGrid corners{2, 2, w.width(), w.length(), w.xMin, w.yMin};
  const double all = w.width() + w.length();
  report.highest = terrain::highestTops(exec, *ground.grains, corners, all).front();
}

} // namespace

void settleUntilRest(const BedSetup& bed, const SettleSetup& wanted, terrain::Grains& grains, double fall,
                     const SettleProgress& progress, SettleReport& report) {
  const terrain::GrainModel& model = grains.model();
  const double g = norm(model.gravity), dt = model.timeStep;
  const double unit = bed.restEnergy * static_cast<double>(grains.count() - grains.system().fixedCount);
  // Loose grains fall first; rest is checked after they have landed.
  const double landed = report.time + std::sqrt(2 * fall / g), limit = report.time + wanted.timeLimit;
  const auto checkEvery = std::max<std::int64_t>(1, static_cast<std::int64_t>(kLookEvery / dt));
  double forceRatio = 0;
  std::size_t looks = 0, calm = 0;
  std::array<double, kCalmLooks> energies{}, ratios{}; // at the last checks, since the energy of a deep bed oscillates
  while (report.time < limit) {
    try {
      for (std::int64_t i = 0; i < checkEvery;) i += grains.advance(checkEvery - i);
    } catch (const base::SimulationError& error) {
      throw base::SimulationError(fmt::format("while the {} settled, before the start of the run: {}",
                                              bed.tile ? "bed of copied tiles" : "bed", error.what()),
                                  base::Cause::unsettledBed);
    }
    report.steps += checkEvery;
    report.time = static_cast<double>(report.steps) * dt;
    if (wanted.forceRatio)
      forceRatio = terrain::forceRatio(grains.system()); // before any other operation, as it requires a step
    const terrain::GrainLedger ledger = grains.ledger();
    report.energyRatio = (ledger.kinetic + (wanted.spins ? ledger.rotational : 0)) / unit;
    progress(report.time, report.energyRatio);
    const bool rests =
        report.energyRatio < wanted.kineticEnergy && (!wanted.forceRatio || forceRatio < *wanted.forceRatio);
    calm = rests ? calm + 1 : 0;
    if (calm >= kCalmLooks && report.time > landed) return;
    energies[looks % kCalmLooks] = report.energyRatio;
    ratios[looks++ % kCalmLooks] = forceRatio;
  }
  const auto most = [](const auto& values) { return *std::max_element(values.begin(), values.end()); };
  throw base::SimulationError(
      fmt::format(
          "the bed did not settle within {:g} s: in the last {} checks, {:.2g} s apart, the kinetic energy per grain "
          "was up to {:.3g} of m g radius, required: less than {:.3g}{}; raise terrain.settle_time_limit, lower "
          "the material's restitution or raise terrain.settle_kinetic_energy{}",
          wanted.timeLimit, std::min(looks, kCalmLooks), static_cast<double>(checkEvery) * dt, most(energies),
          wanted.kineticEnergy,
          wanted.forceRatio ? fmt::format(", and the mean resultant force on a grain up to {:.3g} of its weight, "
                                          "required: less than {:.3g}",
                                          most(ratios), *wanted.forceRatio)
                            : "",
          wanted.forceRatio ? " and settle_force_ratio" : ""),
      base::Cause::unsettledBed);
}

void settleWithFriction(const BedSetup& bed, terrain::Grains& grains, double friction, const SettleProgress& progress,
                        SettleReport& report) {
  const terrain::GrainModel own = grains.model();
  terrain::GrainModel prepared = own;
  // Cohesive grains settle more loosely than any soil compacted by traffic.
  const auto prepare = [friction](contact::ContactLaw& law) {
    law = law.pulling(kPreparedPull);
    if (law.friction > 0) law.friction = friction;
  };
  prepare(prepared.law);
  for (contact::ContactLaw& law : prepared.materials.grains) prepare(law);
  // A bed with so little friction would flow under inclined gravity: gravity is vertical until the grains have their
  // own friction.
  prepared.gravity = {0, 0, -norm(own.gravity)};
  grains.replaceLaws(prepared);
  SettleSetup nearly = bed.settle;
  nearly.kineticEnergy *= kStillPrepared, nearly.forceRatio.reset();
  settleUntilRest(bed, nearly, grains, bed.fall, progress, report);
  grains.replaceLaws(own);
  settleUntilRest(bed, bed.settle, grains, 0, progress, report);
}

namespace {

bool isPossible(double friction) { return friction >= kMinFriction && friction <= kMaxFriction; }

double frictionByTrials(const PreparationSetup& preparation, const base::Exec& exec, const SettleProgress& progress) {
  const double wanted = preparation.porosity;
  const auto at = [&](double friction) { return porosityAt(preparation, friction, exec, progress); };
  double low = kMinFriction, high = kMaxFriction;
  const double densest = at(low), loosest = at(high);
  if (wanted < densest - kOff || wanted > loosest + kOff)
    throw base::InputError(fmt::format(
        "{} cannot be reached: with friction {:g} these grains settle to the porosity {:.3f}, with {:g} to {:.3f}; "
        "choose a porosity between these, or use rolling_friction for looser beds and a wider radius_distribution "
        "for denser beds",
        preparation.place, low, densest, high, loosest));
  if (wanted <= densest + kClose) return low;
  if (wanted >= loosest - kClose) return high;
  // Between 0.01 and 1 the porosity is about linear in the logarithm of the friction: each trial interpolates linearly
  // between the ends of the interval, limited to its middle three fifths.
  low = 0.01;
  double below = densest - wanted, above = loosest - wanted, friction = high;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double share = std::clamp(below / (below - above), 0.2, 0.8);
    friction = low * base::pow(high / low, share);
    const double off = at(friction) - wanted;
    if (std::fabs(off) <= kClose) break;
    if (off < 0)
      low = friction, below = off;
    else
      high = friction, above = off;
  }
  return friction;
}

} // namespace

double frictionFor(const PreparationSetup& preparation, const base::Exec& exec, const SettleProgress& progress,
                   const FoundFrictions* found) {
  const bool isKept = found && !preparation.origin.empty();
  if (isKept)
    if (const auto friction = found->find(preparation.origin); friction && isPossible(*friction)) return *friction;
  const double friction = frictionByTrials(preparation, exec, progress);
  if (isKept) found->keep(preparation.origin, friction);
  return friction;
}

SettleReport settle(const BedSetup& bed, const LaidGround& ground, const SettleProgress& progress,
                    const FoundFrictions* found) {
  terrain::Grains& grains = *ground.grains;
  SettleReport report;
  try {
    if (bed.preparation) {
      report.friction = frictionFor(*bed.preparation, grains.system().exec, progress, found);
      settleWithFriction(bed, grains, report.friction, progress, report);
    } else {
      settleUntilRest(bed, bed.settle, grains, bed.fall, progress, report);
    }
  } catch (const base::SimulationError& error) {
    const std::string message = error.what() + steepnessText(ground);
    if (progress.failed) progress.failed(grains, message, error.cause());
    throw base::SimulationError(message, error.cause());
  }
  measureHeight(ground, report);
  return report;
}

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#include "base/sphere.hpp"
#include "runs/validation/bench/bed_file.hpp"
#include "runs/validation/bench/bench.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/memory_held.hpp"
#include "base/random.hpp"
#include "base/rounded.hpp"
#include "contact/restitution.hpp"
#include "terrain/grains.hpp"
#include "terrain/kernel_choice.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace grouser::bench {

using base::Vec3d;
using Clock = std::chrono::steady_clock;

namespace {

constexpr int kLayers = 5;
constexpr double kSpacing = 2.1;  // [radii]
constexpr double kGravity = 9.81; // [m/s2]
constexpr int kRebuildsTimed = 5;
constexpr std::uint64_t kSeed = 1, kPurpose = base::purpose("bench.bed");

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// Range of grain radii [m].
struct Radii {
  double mean, smallest, largest;
};
/// For radii with a uniform distribution in mean (1 +- s), the mean of r^3 is mean^3 (1 + s^2).
Radii radiiOf(const BedBench& b) {
  const double s = b.radiiSpread, mean = s > 0 ? b.radius * base::pow(1 + s * s, -1.0 / 3) : b.radius;
  return {mean, mean * (1 - s), mean * (1 + s)};
}

/// Contact law of grains with the effective mass `mass` [kg].
contact::ContactLaw lawOf(const BedBench& b, double mass) {
  contact::ContactLaw law;
  const bool manyMasses = b.radiiSpread > 0;
  // 2/7 and 1/2 are the defaults of the tangential ratios in scenes.
  if (b.hertz) {
    const double radius = 0.5 * b.radius, contactRadius = std::sqrt(radius * 1e-3 * b.radius);
    law.hertz = true, law.stiffness = static_cast<float>(b.stiffness / (1.5 * contactRadius));
    law.tangentialStiffness = static_cast<float>(1.2 * law.stiffness);
    law.rootDamping =
        static_cast<float>(2 * contact::hertzDampingRatioFor(b.restitution, false) * std::sqrt(1.5 * law.stiffness));
    law.tangentialRootDamping = static_cast<float>(0.5 * law.rootDamping);
  } else {
    const double ratio = contact::dampingRatioFor(b.restitution, false);
    const double damping = 2 * std::sqrt(b.stiffness / mass) * ratio;
    law.stiffness = static_cast<float>(b.stiffness);
    law.tangentialStiffness = static_cast<float>(b.stiffness * 2 / 7);
    law.damping = manyMasses ? 0 : static_cast<float>(damping);
    law.tangentialDamping = manyMasses ? 0 : static_cast<float>(0.5 * damping);
    law.rootDamping = manyMasses ? static_cast<float>(2 * ratio * std::sqrt(b.stiffness)) : 0;
    law.tangentialRootDamping = static_cast<float>(0.5 * law.rootDamping);
  }
  law.friction = static_cast<float>(b.friction);
  law.rollingFriction = static_cast<float>(b.rolling), law.rollingDamping = b.rolling > 0 ? 0.3f : 0;
  return law;
}

terrain::GrainModel modelOf(const BedBench& b) {
  const Radii radii = radiiOf(b);
  terrain::GrainModel model;
  model.radius = radii.largest, model.smallestRadius = b.radiiSpread > 0 ? radii.smallest : 0;
  model.mass = base::sphereMass(b.density, radii.largest);
  model.timeStep = b.timeStep;
  model.gravity = {0, 0, -kGravity};
  model.skin = b.skin, model.maxSimdLanes = b.lanes;
  model.ledger = b.ledger;
  model.law = lawOf(b, 0.5 * model.mass); // effective mass of a pair
  model.floorLaw = model.law;
  const double lightest = base::sphereMass(b.density, radii.smallest);
  const double limit = contact::stableStep(std::sqrt(8 * b.stiffness / lightest), 0);
  if (b.timeStep > limit)
    throw base::InputError(fmt::format(
        "bench bed: --time-step {:g} s exceeds the longest stable step, {} s, for a grain radius of {} m; reduce it",
        b.timeStep, base::roundedDown(limit, 3), radii.smallest));
  return model;
}

/// Number of lattice sites per side, such that all grains fit into kLayers layers. The top layer may be incomplete.
std::int64_t sideOf(std::int64_t grains) {
  auto side = static_cast<std::int64_t>(std::sqrt(static_cast<double>(grains) / kLayers));
  while (side * side * kLayers < grains) ++side;
  return side;
}

double edgeOf(const BedBench& b) { return static_cast<double>(sideOf(b.grains)) * kSpacing * radiiOf(b).largest; }

std::vector<terrain::GrainSpec> lattice(const BedBench& b) {
  const std::int64_t side = sideOf(b.grains);
  const Radii radii = radiiOf(b);
  const double spacing = kSpacing * radii.largest;
  const double shift = 0.5 * b.jitter * (kSpacing - 2) * radii.largest; // small enough to avoid initial contacts
  std::vector<terrain::GrainSpec> start;
  start.reserve(static_cast<std::size_t>(b.grains));
  for (std::int64_t i = 0; i < b.grains; ++i) {
    const auto id = static_cast<std::uint64_t>(i);
    const auto random = [&](std::uint64_t use) { return 2 * base::uniform(kSeed, kPurpose, id, use) - 1; };
    const std::int64_t column = i % side, row = i / side % side, layer = i / (side * side);
    const Vec3d place{static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5,
                      static_cast<double>(layer) + 0.5};
    terrain::GrainSpec grain{place * spacing + Vec3d{random(0), random(1), random(2)} * shift, {}, {}};
    if (b.radiiSpread > 0) grain.radius = radii.mean * (1 + b.radiiSpread * random(3));
    start.push_back(grain);
  }
  if (!b.fixedFloor) return start;
  // The tops of the fixed grains are at z = 0; the gaps between them are smaller than any grain.
  const double edge = edgeOf(b);
  const auto across = static_cast<std::int64_t>(std::ceil(edge / (2 * radii.smallest)));
  for (std::int64_t i = 0; i < across * across; ++i) {
    const Vec3d place{static_cast<double>(i % across) + 0.5, static_cast<double>(i / across) + 0.5, 0};
    start.push_back(
        {place * (edge / static_cast<double>(across)) - Vec3d{0, 0, radii.mean}, {}, {}, radii.mean, 0, true});
  }
  return start;
}

terrain::Boundaries box(const BedBench& b, const terrain::GrainModel& model) {
  const double edge = edgeOf(b);
  contact::ContactLaw law = model.law;
  // In a contact with a wall, the effective mass is the mass of the grain.
  law.damping /= std::sqrt(2.0f), law.tangentialDamping /= std::sqrt(2.0f);
  terrain::Boundaries box;
  if (!b.fixedFloor) box.walls.push_back({{0, 0, 1}, 0, law});
  if (b.periodic)
    box.periodic = {std::array{0.0, edge}, std::array{0.0, edge}};
  else
    box.walls.insert(box.walls.end(),
                     {{{1, 0, 0}, 0, law}, {{-1, 0, 0}, -edge, law}, {{0, 1, 0}, 0, law}, {{0, -1, 0}, -edge, law}});
  return box;
}

void advance(terrain::Grains& grains, std::int64_t steps) {
  for (std::int64_t i = 0; i < steps;) i += grains.advance(steps - i);
}

double timed(const base::Exec& exec, terrain::Grains& grains, std::int64_t steps) {
  base::synchronize(exec);
  const Clock::time_point start = Clock::now();
  advance(grains, steps);
  base::synchronize(exec);
  return 1e6 * secondsSince(start) / static_cast<double>(steps);
}

} // namespace

double BatchTimes::median() const { return bench::median(microseconds); }
double BatchTimes::least() const { return *std::min_element(microseconds.begin(), microseconds.end()); }
double BatchTimes::most() const { return *std::max_element(microseconds.begin(), microseconds.end()); }

BedFigures benchBed(const BedBench& b, const base::Exec& exec, const base::Comm& comm) {
  if (!b.save.empty() && comm.size() > 1)
    throw base::InputError("bench bed: --save does not support MPI; remove it or use one rank");
  const terrain::GrainModel model = modelOf(b);
  terrain::Grains grains(exec, model, box(b, model), b.start.empty() ? lattice(b) : readBed(b),
                         {comm, {0, 0, 0}, {}, true, b.peerMemory});
  BedFigures f;
  f.law = model.law, f.edge = edgeOf(b);
  const Clock::time_point settling = Clock::now();
  advance(grains, std::llround(b.settleTime / b.timeStep));
  base::synchronize(exec);
  f.settleSeconds = secondsSince(settling);

  // Warm-up; its speed also determines the number of steps in a batch of one second.
  timed(exec, grains, 5);
  const double warm = timed(exec, grains, 20);
  f.times.steps = b.steps > 0 ? b.steps : std::clamp<std::int64_t>(static_cast<std::int64_t>(1e6 / warm), 10, 20000);
  comm.wait();
  f.times.steps = static_cast<std::int64_t>(comm.maximumOf(static_cast<std::uint64_t>(f.times.steps)));
  const std::int64_t before = grains.system().rebuilds;
  const terrain::Subdomain* subdomain = grains.distribution() ? &grains.distribution()->subdomain() : nullptr;
  const std::int64_t sent = subdomain ? subdomain->bytesSent() : 0;
  const double waited = subdomain ? subdomain->waited() : 0;
  const Clock::time_point start = Clock::now();
  for (int k = 0; k < b.batches; ++k) f.times.microseconds.push_back(timed(exec, grains, f.times.steps));
  const std::int64_t rebuilds = grains.system().rebuilds - before, steps = f.times.steps * b.batches;
  f.stepsBetweenRebuilds = rebuilds > 0 ? static_cast<double>(steps) / static_cast<double>(rebuilds)
                                        : std::numeric_limits<double>::infinity();
  f.stepsTaken = grains.steps();
  if (subdomain) {
    f.subdomains = subdomain->partition().shape(), f.way = subdomain->way();
    f.ghostShare =
        static_cast<double>(comm.sumOf(static_cast<std::int64_t>(subdomain->ghosts()))) / static_cast<double>(b.grains);
    const auto perStep = static_cast<std::uint64_t>((subdomain->bytesSent() - sent) / steps);
    f.bytesAStep = static_cast<double>(comm.maximumOf(perStep));
    const double share = (subdomain->waited() - waited) / secondsSince(start);
    double extremes[2] = {share, -share};
    comm.maximum(extremes, 2);
    f.maxWait = extremes[0], f.minWait = -extremes[1];
  }
  if (!b.save.empty()) saveBed(grains, b.save);
  if (b.hash) f.stateHash = terrain::hashOf(grains.state(), comm).hex();

  base::restartMemoryPeak(exec);
  std::vector<double> rebuild;
  for (int k = 0; k < kRebuildsTimed; ++k) {
    grains.invalidateNeighbours();
    comm.wait();
    const Clock::time_point from = Clock::now();
    grains.refreshNeighbours();
    base::synchronize(exec);
    rebuild.push_back(1e6 * secondsSince(from));
  }
  f.rebuildMicroseconds = median(rebuild);
  const double n = static_cast<double>(b.grains);
  const auto perGrain = [&](std::uint64_t share) {
    return static_cast<double>(comm.sumOf(static_cast<std::int64_t>(share))) / n;
  };
  const base::MemoryHeld held = base::memoryHeld(exec);
  f.peakBytesPerGrain = perGrain(held.most), f.reservedPerGrain = perGrain(held.reserved);
  const terrain::GrainLedger ledger = grains.ledger();
  f.contactsPerGrain = static_cast<double>(ledger.contacts + ledger.boundaryContacts) / n;
  f.kineticPerGrain =
      (ledger.kinetic + ledger.rotational) / n / (base::sphereMass(b.density, b.radius) * kGravity * b.radius);
  f.features = terrain::featureText(grains.system().constants.features);
  f.listLength = perGrain(grains.system().neighbours.listed());
  f.bytesPerGrain = perGrain(grains.system().deviceBytes());
  return f;
}

} // namespace grouser::bench

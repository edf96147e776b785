// SPDX-License-Identifier: BSD-3-Clause
#include "base/sphere.hpp"
#include "runs/bench/bench.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/rounded.hpp"
#include "contact/restitution.hpp"
#include "terrain/grains.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>

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

terrain::GrainModel modelOf(const BedBench& b) {
  terrain::GrainModel model;
  model.radius = b.radius;
  model.mass = base::sphereMass(b.density, b.radius);
  model.timeStep = b.timeStep;
  model.gravity = {0, 0, -kGravity};
  model.skin = b.skin, model.mostSimdLanes = b.lanes;
  model.ledger = b.ledger;
  // A pair of grains weighs half a grain; 2/7 and 1/2 are the scene's defaults of the tangential ratios.
  const double damping =
      2 * std::sqrt(b.stiffness / (0.5 * model.mass)) * contact::dampingRatioFor(b.restitution, false);
  model.law.stiffness = static_cast<float>(b.stiffness);
  model.law.damping = static_cast<float>(damping);
  model.law.tangentialStiffness = static_cast<float>(b.stiffness * 2 / 7);
  model.law.tangentialDamping = static_cast<float>(0.5 * damping);
  model.law.friction = static_cast<float>(b.friction);
  model.floorLaw = model.law;
  const double limit = contact::stableStep(std::sqrt(8 * b.stiffness / model.mass), 0);
  if (b.timeStep > limit)
    throw base::InputError(fmt::format(
        "bench bed: a step of {:g} s is above {} s, where grains of radius {} m become unstable; give --time-step",
        b.timeStep, base::roundedDown(limit, 3), b.radius));
  return model;
}

/// Places on the side of the lattice that holds all grains in kLayers layers; the top layer may be incomplete.
std::int64_t sideOf(std::int64_t grains) {
  auto side = static_cast<std::int64_t>(std::sqrt(static_cast<double>(grains) / kLayers));
  while (side * side * kLayers < grains) ++side;
  return side;
}

std::vector<terrain::GrainSpec> lattice(const BedBench& b) {
  const std::int64_t side = sideOf(b.grains);
  const double spacing = kSpacing * b.radius;
  const double shift = 0.5 * b.jitter * (kSpacing - 2) * b.radius; // grains never touch at the start
  std::vector<terrain::GrainSpec> start;
  start.reserve(static_cast<std::size_t>(b.grains));
  for (std::int64_t i = 0; i < b.grains; ++i) {
    const auto id = static_cast<std::uint64_t>(i);
    const auto shake = [&](std::uint64_t axis) { return (2 * base::uniform(kSeed, kPurpose, id, axis) - 1) * shift; };
    const std::int64_t column = i % side, row = i / side % side, layer = i / (side * side);
    const Vec3d place{static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5,
                      static_cast<double>(layer) + 0.5};
    start.push_back({place * spacing + Vec3d{shake(0), shake(1), shake(2)}, {}, {}});
  }
  return start;
}

terrain::Boundaries box(const BedBench& b, const terrain::GrainModel& model) {
  const double edge = static_cast<double>(sideOf(b.grains)) * kSpacing * b.radius;
  contact::ContactLaw law = model.law;
  // Against a wall the whole grain swings: the same restitution is less damping.
  law.damping /= std::sqrt(2.0f), law.tangentialDamping /= std::sqrt(2.0f);
  return {{{{0, 0, 1}, 0, law},
           {{1, 0, 0}, 0, law},
           {{-1, 0, 0}, -edge, law},
           {{0, 1, 0}, 0, law},
           {{0, -1, 0}, -edge, law}},
          {}};
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
  const terrain::GrainModel model = modelOf(b);
  terrain::Grains grains(exec, model, box(b, model), lattice(b), {comm, {0, 0, 0}, {}, true, b.peerMemory});
  BedFigures f;
  const Clock::time_point settling = Clock::now();
  advance(grains, std::llround(b.settleTime / b.timeStep));
  base::synchronize(exec);
  f.settleSeconds = secondsSince(settling);

  // Warm-up; it also tells how many steps a batch of one second takes.
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
    f.mostWait = extremes[0], f.leastWait = -extremes[1];
  }
  if (b.hash) f.stateHash = terrain::hashOf(grains.state(), comm).hex();

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
  const terrain::GrainLedger ledger = grains.ledger();
  f.contactsPerGrain = static_cast<double>(ledger.contacts + ledger.boundaryContacts) / n;
  f.kineticPerGrain = (ledger.kinetic + ledger.rotational) / n / (model.mass * kGravity * b.radius);
  const std::vector<std::uint32_t> count = grains.system().neighbours.toHost().count;
  f.listLength = static_cast<double>(comm.sumOf(std::accumulate(count.begin(), count.end(), std::int64_t{0}))) / n;
  f.bytesPerGrain = static_cast<double>(comm.sumOf(static_cast<std::int64_t>(grains.system().deviceBytes()))) / n;
  return f;
}

} // namespace grouser::bench

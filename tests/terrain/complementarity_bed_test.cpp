// SPDX-License-Identifier: BSD-3-Clause
// Many grains with complementarity contacts: identical results, momentum and energies.
#include "base/error.hpp"
#include "impulse_fixture.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

using contact::Compliance;

Boundaries corner(const GrainModel& m) { return {{floorPlane(m.law), {{1, 0, 0}, -0.05, m.law}}, {}}; }

/// A block thrown into a corner.
Grains thrown(const base::Exec& exec, const GrainModel& m) {
  return {exec, m, corner(m), gravelBlock(6, 6, 5, {-0.6, 0.2, -1}, {1, 2, 3})};
}

struct EndOfBed {
  std::vector<std::uint32_t> words;
  std::int64_t iterations;
  double residual, dissipated;
  bool operator==(const EndOfBed&) const = default;
};
EndOfBed endOfBed(Grains& grains) {
  const ImpulseSolver& solver = *grains.system().impulses;
  return {grains.state().words(), solver.totals().iterations, solver.report().residual, grains.ledger().dissipated()};
}

constexpr int kBedSteps = 100;

EndOfBed bedAfterSteps(const base::Exec& exec, Compliance compliance, double skin,
                       Precision precision = Precision::single) {
  GrainModel m = impulsiveGravel(compliance, skin);
  m.precision = precision;
  Grains grains = thrown(exec, m);
  advance(grains, kBedSteps);
  return endOfBed(grains);
}

class ComplementarityBed : public ::testing::TestWithParam<Compliance> {};

TEST_P(ComplementarityBed, HasTheSameBitsForThreadsAndRebuildIntervals) {
  const EndOfBed reference = bedAfterSteps(testExec(1), GetParam(), 0.3);
  EXPECT_GT(reference.iterations, kBedSteps);
  EXPECT_EQ(bedAfterSteps(testExec(2), GetParam(), 0.3), reference);
  EXPECT_EQ(bedAfterSteps(testExec(1), GetParam(), 0.8), reference);
}

TEST_P(ComplementarityBed, HasTheSameBitsOnCuda) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  for (const Precision p : {Precision::single, Precision::double_})
    EXPECT_EQ(bedAfterSteps(base::cudaExec(), GetParam(), 0.3, p), bedAfterSteps(base::cpuExec(1), GetParam(), 0.3, p));
}

TEST_P(ComplementarityBed, GoesOnToTheSameBits) {
  const GrainModel m = impulsiveGravel(GetParam());
  Grains first = thrown(testExec(1), m);
  advance(first, 60);
  const GrainState saved = first.state();
  Grains second(testExec(2), m, corner(m), gravelBlock(6, 6, 5, {}));
  second.restore(saved);
  EXPECT_EQ(second.state().words(), saved.words());
  advance(second, kBedSteps - 60);
  EXPECT_EQ(endOfBed(second), bedAfterSteps(testExec(1), GetParam(), 0.3));
}

TEST_P(ComplementarityBed, KeepsMomentumAndItsBooks) {
  GrainModel m = impulsiveGravel(GetParam());
  Grains grains = thrown(testExec(1), m);
  const GrainLedger before = grains.ledger();
  advance(grains, kBedSteps);
  const GrainLedger after = grains.ledger();
  EXPECT_LT(norm(after.momentum - before.momentum - after.impulse), 1e-5 * norm(after.impulse));
  EXPECT_LT(norm(after.angularMomentum - before.angularMomentum - after.angularImpulse),
            1e-5 * norm(after.angularImpulse));
  const double gained = after.kinetic + after.rotational - before.kinetic - before.rotational;
  EXPECT_NEAR(after.work, gained, 1e-6 * after.turnover);
  // Implicit steps dissipate the remainder: less than a tenth. It is positive except for g h / 2 times the momentum:
  // positions are half a step ahead of velocities.
  const double lost = before.potential - after.potential + before.elastic - after.elastic - after.dissipated() - gained;
  EXPECT_GT(lost, 0.5 * 9.81 * m.timeStep * (before.momentum.z - after.momentum.z) - 1e-3 * after.turnover);
  EXPECT_LT(lost, 0.1 * after.turnover);
}

INSTANTIATE_TEST_SUITE_P(Both, ComplementarityBed, ::testing::Values(Compliance::law, Compliance::rigid));

/// A block of three sizes with rolling resistance and cohesion.
std::vector<GrainSpec> mixedBlock(const base::Vec3d& velocity, const base::Vec3d& spin) {
  std::vector<GrainSpec> start = gravelBlock(6, 5, 4, velocity, spin);
  for (std::size_t k = 0; k < start.size(); ++k) start[k].radius = 0.021 + 0.003 * static_cast<double>(k * 7 % 3);
  return start;
}
GrainModel mixedGravel(Compliance compliance, double skin = 0.3) {
  GrainModel m = impulsiveGravel(compliance, skin);
  m.law.rollingFriction = 0.1, m.law.rollingDamping = 0.3, m.law.pullPerRadius = 20;
  return m;
}

TEST_P(ComplementarityBed, PairsOfAllSizesBalance) {
  GrainModel m = mixedGravel(GetParam());
  m.gravity = {}, m.complementarity->iterations = 30; // regardless of the solver's accuracy
  Grains grains(testExec(2), m, {}, mixedBlock({}, {1, -2, 3}));
  const std::vector<GrainSpec> bullet{{{0.1, 0.1, 0.3}, {0, 0, -3}, {}, 0.024}};
  grains.add(bullet);
  const GrainLedger before = grains.ledger();
  advance(grains, 60);
  const GrainLedger after = grains.ledger();
  ASSERT_GT(after.dissipated(), 0.1 * before.kinetic);
  // Single precision rounds the sums of a grain, not the impulses of a pair.
  EXPECT_LT(norm(after.momentum - before.momentum), 1e-6 * norm(before.momentum));
  EXPECT_LT(norm(after.angularMomentum - before.angularMomentum), 1e-6 * norm(before.angularMomentum));
}

TEST_P(ComplementarityBed, OfManySizesBetweenPeriodicSidesOverFixedGrainsHasTheSameBits) {
  const auto end = [&](int threads, double skin) {
    GrainModel m = mixedGravel(GetParam(), skin);
    m.maxOverlap = 1;
    Boundaries sides{{floorPlane(m.law)}, {}};
    sides.periodic[0] = {{-0.03, 0.33}};
    std::vector<GrainSpec> start = mixedBlock({-0.8, 0.2, -1}, {1, 2, 3});
    for (std::size_t k = 0; k < 30; ++k) start[k].fixed = true, start[k].velocity = start[k].spin = {};
    Grains grains(testExec(threads), m, sides, start);
    advance(grains, kBedSteps);
    return endOfBed(grains);
  };
  const EndOfBed reference = end(1, 0.3);
  EXPECT_EQ(end(2, 0.3), reference);
  EXPECT_EQ(end(1, 0.8), reference);
}

TEST(ComplementarityOfMany, ShorterStepsMeetThePenaltyLaw) {
  // Both methods integrate the same springs, so that the rebound differs by an error of first order in the step.
  const auto place = [](double step, bool solved) {
    GrainModel m = solved ? impulsiveGravel(Compliance::law) : gravel();
    m.timeStep = step, m.precision = Precision::double_, m.law.damping = 500;
    if (solved)
      m.complementarity->residual = 1e-9, m.complementarity->iterations = 5000, m.complementarity->impact = 1e9;
    Grains grains(testExec(2), m, {{floorPlane(m.law)}, {}}, {{{0, 0, 0.0271}, {0.2, 0, -0.3}, {}}});
    advance(grains, std::lround(0.05 / step));
    return grains.snapshot().velocity[0].as<double>();
  };
  const base::Vec3d exact = place(1e-6, false);
  const double coarse = norm(place(1e-5, true) - exact), fine = norm(place(2.5e-6, true) - exact);
  EXPECT_LT(fine, 0.05 * norm(exact));
  EXPECT_NEAR(coarse / fine, 4, 1) << "first order";
}

TEST(ComplementarityOfMany, AStrictRunEndsWhereAStepIsNotSolved) {
  GrainModel m = impulsiveGravel(Compliance::law);
  m.complementarity->iterations = 15, m.complementarity->strict = true;
  Grains grains = thrown(testExec(1), m);
  EXPECT_THROW(advance(grains, kBedSteps), base::SimulationError);
  m.complementarity->strict = false;
  Grains marked = thrown(testExec(1), m);
  advance(marked, kBedSteps);
  EXPECT_GT(marked.system().impulses->totals().missed, 10);
  EXPECT_GT(marked.system().impulses->totals().worst, m.complementarity->residual);
}

} // namespace
} // namespace grouser::terrain::testing

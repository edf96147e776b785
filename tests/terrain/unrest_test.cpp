// SPDX-License-Identifier: BSD-3-Clause
// The resultant force on a grain as a share of its weight.
#include "grain_fixture.hpp"
#include "terrain/grain_forces.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain {
namespace {

using testing::advance;
using testing::ball;
using testing::floorPlane;

GrainModel dampedBall() {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  m.law.damping = 500;
  return m;
}

TEST(ForceRatio, FreeFall_IsOne) {
  const GrainModel m = dampedBall();
  Grains grains(base::cpuExec(2), m, {}, {{{0, 0, 1}, {}, {}}, {{1, 0, 1}, {1, 0, 0}, {}}, {{2, 0, 1}, {}, {}}});
  advance(grains, 3);
  // A float up to 1 m/s resolves 6e-8 m/s, relative to g dt = 9.8e-5 m/s; the sum has a quantum of 2^-24 of that.
  EXPECT_NEAR(forceRatio(grains.system()), 1.0, 1e-3);
}

TEST(ForceRatio, HalfOfTheGrainsAtRest_IsOneHalf) {
  const GrainModel m = dampedBall();
  // One is on the plane where spring and weight balance, the other falls.
  const double overlap = m.mass * norm(m.gravity) / m.law.stiffness;
  Grains grains(base::cpuExec(1), m, {{floorPlane(m.law)}, {}},
                {{{0, 0, m.radius - overlap}, {}, {}}, {{1, 0, 1}, {}, {}}});
  advance(grains, 2);
  EXPECT_NEAR(forceRatio(grains.system()), 0.5, 1e-3);
}

TEST(ForceRatio, IsTheMeanOverTheGrainsThatMayMove) {
  const GrainModel m = dampedBall();
  GrainSpec fixed{{1, 0, 1}, {}, {}};
  fixed.fixed = true;
  Grains grains(base::cpuExec(1), m, {}, {{{0, 0, 1}, {}, {}}, fixed});
  advance(grains, 2);
  EXPECT_NEAR(forceRatio(grains.system()), 1.0, 1e-3);
}

TEST(ForceRatio, DecaysAsABallComesToRest) {
  const GrainModel m = dampedBall();
  Grains grains(base::cpuExec(1), m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {}, {}}});
  advance(grains, 1);
  EXPECT_NEAR(forceRatio(grains.system()), 1.0, 1e-6);
  advance(grains, 10000); // 0.1 s; the oscillation decays as exp(-gamma t / 2), by exp(-25)
  // At rest the spring is accurate to one unit of position.
  EXPECT_LT(forceRatio(grains.system()), m.law.stiffness * grains.scale().unit / (m.mass * norm(m.gravity)));
}

TEST(ForceRatio, IsTheSameOnEveryDevice) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  double ratio[2];
  const base::Exec execs[] = {base::cpuExec(1), base::cudaExec()};
  for (int k = 0; k < 2; ++k) {
    const GrainModel m = dampedBall();
    Grains grains(execs[k], m, {{floorPlane(m.law)}, {}}, {{{0, 0, m.radius}, {}, {}}, {{1, 0, 1}, {}, {}}});
    advance(grains, 50);
    ratio[k] = forceRatio(grains.system());
  }
  EXPECT_EQ(ratio[0], ratio[1]);
}

} // namespace
} // namespace grouser::terrain

// SPDX-License-Identifier: BSD-3-Clause
// Rigid surfaces, fixed and moving: nearest points, closed forms of rest, rolling and transport, loads; identical bits.
#include "surface_fixture.hpp"
#include "terrain/kernel_choice.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain::testing {
namespace {

void expectGap(const SurfaceGeometry& g, const Vec3d& p, const Vec3d& normal, double distance) {
  const SurfaceGap gap = gapTo(g, p);
  EXPECT_NEAR(gap.distance, distance, 1e-15) << "round-off of a length of 1";
  EXPECT_LT(norm(gap.normal - base::normalized(normal)), 1e-15) << p.x << " " << p.y << " " << p.z;
}

TEST(SurfaceGap, BoxHasFacesEdgesAndCornersAndAnInside) {
  const SurfaceGeometry box = boxOf({0.5, 0.3, 0.2});
  expectGap(box, {0.1, 0.1, 0.6}, {0, 0, 1}, 0.4);
  expectGap(box, {0.1, -0.7, 0.1}, {0, -1, 0}, 0.4);
  expectGap(box, {0.8, 0.7, 0.1}, {3, 4, 0}, 0.5);
  expectGap(box, {0.7, -0.5, -0.3}, {2, -2, -1}, 0.3);
  expectGap(box, {0.4, 0.1, 0}, {1, 0, 0}, -0.1);
  expectGap(box, {0, 0, -0.19}, {0, 0, -1}, -0.01);
}

TEST(SurfaceGap, CylinderHasASideTwoEndsAndRims) {
  const SurfaceGeometry rod = cylinderOf(0.5, 0.4);
  expectGap(rod, {0.6, 0.8, 0.1}, {3, 4, 0}, 0.5);
  expectGap(rod, {0.1, 0.2, -0.9}, {0, 0, -1}, 0.5);
  expectGap(rod, {0, 0.8, 0.8}, {0, 3, 4}, 0.5);
  expectGap(rod, {0.4, 0, 0.1}, {1, 0, 0}, -0.1);
  expectGap(rod, {0, 0, 0.35}, {0, 0, 1}, -0.05);
}

TEST(SurfaceGap, TubeIsFeltFromBothSidesAndAtItsRims) {
  const SurfaceGeometry tube = tubeOf(0.5, 0.4);
  expectGap(tube, {0.3, 0, 0.1}, {-1, 0, 0}, 0.2);
  expectGap(tube, {0, -0.7, 0.1}, {0, -1, 0}, 0.2);
  expectGap(tube, {0.2, 0, 0.8}, {-3, 0, 4}, 0.5);
  expectGap(tube, {0.8, 0, -0.8}, {3, 0, -4}, 0.5);
}

TEST(SurfaceTravel, LeavesOutWhatDoesNotChangeTheSurface) {
  const SurfaceGeometry plane{SurfaceShape::plane, {}};
  const base::Quat tilted = turn({0, 1, 0}, 0.3);
  const auto a = placed({}, tilted);
  EXPECT_LT(travelBetween(plane, a, placed(rotate(tilted, {2, 1, 0}), tilted)).way, 1e-15);
  EXPECT_NEAR(travelBetween(plane, a, placed(rotate(tilted, {2, 1, 0.1}), tilted)).way, 0.1, 1e-15);
  EXPECT_LT(travelBetween(tubeOf(1, 1), a, placed({}, tilted, turn(rotate(tilted, {0, 0, 1}), 1))).turn, 1e-15);
  // No bound is exceeded: a point at p approaches by at most travel + turn |p - centre|.
  const SurfaceGeometry shapes[] = {plane, boxOf({0.5, 0.3, 0.2}), cylinderOf(0.5, 0.4), tubeOf(0.5, 0.4)};
  for (const SurfaceGeometry& g : shapes)
    for (int k = 0; k < 200; ++k) {
      const auto u = [k](int c) { return base::sin(1.7 * k + 2.3 * c + 0.1 * k * c); };
      const auto before = placed({u(0), u(1), u(2)}, turn({u(3), u(4), 1.5}, 3 * u(5)));
      const auto after = placed({u(0) + 0.1 * u(6), u(1) + 0.1 * u(7), u(2) + 0.1 * u(8)},
                                turn({u(3), u(4), 1.5}, 3 * u(5)), turn({u(9), u(10), 1.2}, 0.3 * u(11)));
      const Vec3d p{2 * u(12), 2 * u(13), 2 * u(14)};
      const SurfaceTravel t = travelBetween(g, before, after);
      const double was = gapTo(g, before.motion.toPart(p)).distance, is = gapTo(g, after.motion.toPart(p)).distance;
      EXPECT_LE(std::fabs(is - was), t.way + t.turn * norm(p - before.motion.centre) + 1e-12);
    }
}

TEST(BallOnBox, RestsOnFaceEdgeAndCornerAtItsStaticOverlap) {
  GrainModel m = ball(1e-5);
  m.law.damping = 2 * 0.7 * std::sqrt(m.law.stiffness / m.mass);
  const double g = 9.81, overlap = m.mass * g / m.law.stiffness;
  const Vec3d half{0.03, 0.02, 0.01};
  const base::Quat stands = turn({1, 2, 3}, 0.8);
  const Vec3d centre{0.1, -0.2, 0.3};
  for (const Vec3d& out : {Vec3d{0, 0, 1}, Vec3d{0, 1, 1}, Vec3d{1, 0, -1}, Vec3d{1, 1, 1}, Vec3d{-1, 1, 1}}) {
    const Vec3d n = base::normalized(out), foot{out.x * half.x, out.y * half.y, out.z * half.z};
    m.gravity = rotate(stands, n * -g);
    Grains grains(testExec(1), m, {{}, {}, {}, {{boxOf(half), m.law, placed(centre, stands)}}},
                  {{centre + rotate(stands, foot + n * m.radius), {}, {}}});
    advance(grains, 5000);
    const Vec3d x = transposedTimes(stands.matrix(), grains.snapshot().position[0] - centre) - foot;
    EXPECT_LT(norm(x - n * (m.radius - overlap)), 2e-3 * overlap) << "a float's force; on edges it starts to roll off";
    const Vec3d force = grains.system().boundaries.surfaceLoads()[0].force;
    EXPECT_LT(norm(force - m.gravity * m.mass), 1e-3 * m.mass * g);
    const Vec3d torque = cross(rotate(stands, foot), m.gravity * m.mass);
    EXPECT_LT(norm(grains.system().boundaries.surfaceLoads()[0].torque - torque), 1e-3 * m.mass * g * norm(half));
  }
}

TEST(BallInDrum, SwingsWithThePeriodOfRolling) {
  // theta'' = -(5/7) g / (R - r) sin(theta): rolling in a drum at rest.
  const GrainModel m = roughBall(5e-6, 0.6, 0.5);
  const double radius = 0.03, arm = radius - m.radius, angle = 0.1;
  const base::Quat along = turn({1, 0, 0}, base::kPi / 2);
  Grains grains(testExec(1), m, {{}, {}, {}, {{tubeOf(radius, 0.05), m.law, placed({}, along)}}},
                {{{arm * base::sin(angle), 0, -arm * base::cos(angle)}, {}, {}}});
  const double period = 2 * base::kPi * std::sqrt(7 * arm / (5 * 9.81)) * (1 + angle * angle / 16);
  double last = 1, crossing = 0;
  for (int n = 0; static_cast<double>(n) * m.timeStep < 0.3 * period && crossing == 0; n += 20) {
    advance(grains, 20);
    const double x = grains.snapshot().position[0].x;
    if (last > 0 && x <= 0) crossing = (n + 20 * last / (last - x)) * m.timeStep;
    last = x;
  }
  EXPECT_NEAR(4 * crossing / period, 1, 2e-3) << "the springs yield for a fraction of a contact";
}

TEST(BallInDrum, ThatTurnsWithItFeelsNoRollingResistance) {
  // Pressed to the wall only by rotation, spinning with the drum: no sliding or rolling.
  const double omega = 40, radius = 0.03;
  GrainModel m = ball(1e-5);
  m.law.friction = 0.6, m.law.tangentialStiffness = m.law.stiffness * 2 / 7;
  m.law.rollingFriction = 0.3, m.law.rollingDamping = 0.3;
  const double arm = (radius - m.radius) / (1 - m.mass * omega * omega / m.law.stiffness); // the spring yields
  const SurfaceGeometry drum = tubeOf(radius, 0.05);
  Grains grains(testExec(1), m, {{}, {}, {}, {{drum, m.law, placed({})}}},
                {{{arm, 0, 0}, {0, omega * arm, 0}, {0, 0, omega}}});
  const auto motion = [&](std::int64_t n) {
    return std::vector{placed({}, {}, turn({0, 0, 1}, omega * static_cast<double>(n) * m.timeStep), {}, {0, 0, omega})};
  };
  advanceWith(grains, motion, 0, 20000);
  EXPECT_NEAR(static_cast<double>(grains.snapshot().spin[0].z), omega, 1e-3 * omega);
  EXPECT_LT(grains.ledger().dissipated(), 1e-4 * grains.ledger().kinetic);
  EXPECT_EQ(grains.system().boundaries.listings(), grains.system().rebuilds)
      << "a drum rotating about its axis needs no rebuild";
}

TEST(BallOnBelt, IsCarriedOffSlidingThenRolling) {
  // A5 in the frame of the belt: it slides at v0, decelerated by mu g, and then rolls at 5/7 of it.
  const double mu = 0.3, v0 = 1;
  const GrainModel m = roughBall(2e-6, mu, 0.3);
  const double overlap = m.mass * 9.81 / m.law.stiffness;
  const SurfacePose belt = placed({}, {}, {}, {v0, 0, 0});
  Grains grains(testExec(1), m, {{}, {}, {}, {{{SurfaceShape::plane, {}}, m.law, belt}}},
                {{{0, 0, m.radius - overlap}, {}, {}}});
  const double tRoll = 2 * v0 / (7 * mu * 9.81);
  advance(grains, static_cast<std::int64_t>(0.5 * tRoll / m.timeStep));
  EXPECT_NEAR(grains.snapshot().velocity[0].x, mu * 9.81 * 0.5 * tRoll, 1e-4) << "constant acceleration mu g";
  EXPECT_NEAR(grains.system().boundaries.surfaceLoads()[0].force.x, -mu * m.mass * 9.81, 1e-4 * m.mass * 9.81)
      << "the pull of the belt";
  advance(grains, static_cast<std::int64_t>(0.6 * tRoll / m.timeStep));
  EXPECT_NEAR(grains.snapshot().velocity[0].x, 2 * v0 / 7, 1e-3);
  EXPECT_EQ(grains.system().boundaries.listings(), grains.system().rebuilds)
      << "a belt moving along itself needs no rebuild";
}

TEST(BallOnTurntable, RollsRoundWithTwoSeventhsOfItsSpin) {
  // A ball that rolls on a table of spin W moves on a circle at 2/7 W (Milne 1948; Weltner 1979, Am. J. Phys. 47:984).
  const double spin = 6, rho = 0.05;
  const GrainModel m = roughBall(5e-6, 0.8, 0.5);
  const double overlap = m.mass * 9.81 / m.law.stiffness;
  Grains grains(testExec(1), m, {{}, {}, {}, {{boxOf({0.1, 0.1, 0.01}), m.law, placed({0, 0, -0.01})}}},
                {{{rho, 0, m.radius - overlap}, {0, 2 * spin * rho / 7, 0}, {5 * spin * rho / (7 * m.radius), 0, 0}}});
  const auto motion = [&](std::int64_t n) {
    return std::vector{
        placed({0, 0, -0.01}, {}, turn({0, 0, 1}, spin * static_cast<double>(n) * m.timeStep), {}, {0, 0, spin})};
  };
  const double quarter = base::kPi / 2 / (2 * spin / 7);
  advanceWith(grains, motion, 0, std::llround(quarter / m.timeStep));
  const Vec3d x = grains.snapshot().position[0];
  EXPECT_LT(norm(x - Vec3d{0, rho, m.radius - overlap}), 5e-3 * rho) << "springs yield at the start";
  EXPECT_GT(grains.system().boundaries.listings(), grains.system().rebuilds) << "the corners of the table move round";
}

TEST(BallOnTurntable, ThatSticksDoesNotCreepSinceItsSpringTurnsWithTheTable) {
  // Rolling resistance holds it; a soft tangential spring of length s would creep by W s per second in
  // world axes.
  const double spin = 10, rho = 0.05;
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  m.law.friction = 2, m.law.rollingFriction = 5, m.law.rollingDamping = 1, m.law.tangentialStiffness = 50;
  m.law.damping = 2 * 0.5 * std::sqrt(m.law.stiffness / m.mass), m.law.tangentialDamping = m.law.damping;
  const double overlap = m.mass * 9.81 / m.law.stiffness;
  Grains grains(testExec(1), m, {{}, {}, {}, {{{SurfaceShape::plane, {}}, m.law, placed({})}}},
                {{{rho, 0, m.radius - overlap}, {0, spin * rho, 0}, {0, 0, spin}}});
  const auto motion = [&](std::int64_t n) {
    return std::vector{placed({}, {}, turn({0, 0, 1}, spin * static_cast<double>(n) * m.timeStep), {}, {0, 0, spin})};
  };
  const auto inTableAfter = [&](std::int64_t first, std::int64_t last) {
    advanceWith(grains, motion, first, last);
    return motion(last)[0].motion.toPart(grains.snapshot().position[0]);
  };
  const Vec3d settled = inTableAfter(0, 50000), later = inTableAfter(50000, 100000);
  const double spring = m.mass * spin * spin * rho / m.law.tangentialStiffness;
  EXPECT_LT(norm(later - settled), 0.01 * spin * spring * 0.5) << "one per cent of the creep in world axes";
}

TEST(Loads, AreTheMomentumThatGrainsHaveLost) {
  GrainModel m = millModel();
  m.gravity = {};
  Grains grains(testExec(1), m, {{}, {}, {}, mill(m.law)}, millGrains());
  const Motion motion = millMotion(m.timeStep);
  const Vec3d before = grains.ledger().momentum;
  Vec3d impulse;
  for (std::int64_t n = 0; n < 3000; ++n) {
    advanceWith(grains, motion, n, n + 1);
    for (const SurfaceLoad& load : grains.system().boundaries.surfaceLoads()) impulse += load.force * m.timeStep;
  }
  EXPECT_GT(norm(impulse), 1e-3) << "they have touched";
  const auto count = static_cast<double>(grains.count());
  EXPECT_LT(norm(grains.ledger().momentum + impulse - before), count * m.mass * 6e-8 * 2)
      << "velocities are read as floats of up to 2 m/s; forces are exact opposites";
}

std::vector<std::uint32_t> runMill(int threads, double skin, bool special = true, Precision precision = {},
                                   std::vector<SurfaceLoad>* loads = nullptr) {
  GrainModel m = millModel(skin);
  m.specialised = special, m.precision = precision;
  Grains grains(testExec(threads), m, {{{{0, 1, 0}, -0.1, m.law}}, {}, {}, mill(m.law)}, millGrains());
  advanceWith(grains, millMotion(m.timeStep), 0, 4000);
  if (loads) *loads = grains.system().boundaries.surfaceLoads();
  return grains.state().words();
}

TEST(Mill, SameBitsForThreadsRebuildIntervalsAndKernels) {
  const auto expected = runMill(1, 0.3);
  EXPECT_EQ(runMill(2, 0.3), expected);
  EXPECT_EQ(runMill(1, 0.9), expected);
  EXPECT_EQ(runMill(2, 0.15), expected);
  EXPECT_EQ(runMill(1, 0.3, false), expected);
  const auto fine = runMill(1, 0.3, true, Precision::double_);
  EXPECT_NE(fine, expected);
  EXPECT_EQ(runMill(2, 0.7, false, Precision::double_), fine);
}

TEST(Mill, ResumedRunGivesTheSameBitsAndLoads) {
  std::vector<SurfaceLoad> loads;
  const auto expected = runMill(1, 0.3, true, {}, &loads);
  const GrainModel m = millModel();
  const Motion motion = millMotion(m.timeStep);
  for (const std::int64_t stop : {0, 1, 1777}) {
    Grains first(testExec(1), m, {{{{0, 1, 0}, -0.1, m.law}}, {}, {}, mill(m.law)}, millGrains());
    advanceWith(first, motion, 0, stop);
    Grains second(testExec(1), m, {{{{0, 1, 0}, -0.1, m.law}}, {}, {}, mill(m.law)}, millGrains());
    second.setSurfacePoses(motion(stop));
    second.restore(first.state());
    advanceWith(second, motion, stop, 4000);
    EXPECT_EQ(second.state().words(), expected) << "stopped at " << stop;
    for (std::size_t s = 0; s < loads.size(); ++s) {
      EXPECT_EQ(second.system().boundaries.surfaceLoads()[s].force, loads[s].force);
      EXPECT_EQ(second.system().boundaries.surfaceLoads()[s].torque, loads[s].torque);
    }
  }
}

TEST(Mill, ListsLoseNoContact) {
  // Lists rebuilt in every step against lists rebuilt on demand of surfaces and grains.
  const GrainModel m = millModel();
  Grains seldom(testExec(1), m, {{}, {}, {}, mill(m.law)}, millGrains()),
      always(testExec(1), m, {{}, {}, {}, mill(m.law)}, millGrains());
  const Motion motion = millMotion(m.timeStep);
  for (std::int64_t n = 0; n < 3000; ++n) {
    always.invalidateNeighbours();
    advanceWith(always, motion, n, n + 1);
    advanceWith(seldom, motion, n, n + 1);
  }
  EXPECT_EQ(seldom.state().words(), always.state().words());
  EXPECT_LT(seldom.system().boundaries.listings(), 600) << "the plate moves by 4 mm, the margin is 2.5 mm";
}

TEST(Surfaces, ListsMadeBetweenRebuildsKeepWallsThatAGrainMayComeBackTo) {
  // It rises by nearly half the skin and falls back to the floor, while a distant box requires rebuild after rebuild.
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  const double gap = 5e-4, rise = 0.95 * 0.5 * m.skin * m.radius;
  const auto motion = [&](std::int64_t n) {
    return std::vector{placed({0.5 + 2 * static_cast<double>(n) * m.timeStep, 0, 0}, {}, {}, {2, 0, 0})};
  };
  const auto after = [&](bool always) {
    Grains grains(testExec(1), m, {{floorPlane(m.law)}, {}, {}, {{boxOf({0.1, 0.1, 0.1}), m.law, placed({0.5, 0, 0})}}},
                  {{{0, 0, m.radius + gap}, {0, 0, std::sqrt(2 * 9.81 * rise)}, {}}});
    for (std::int64_t n = 0; n < 4500; ++n) {
      if (always) grains.invalidateNeighbours();
      advanceWith(grains, motion, n, n + 1);
    }
    if (!always) {
      EXPECT_GT(grains.system().boundaries.listings(), grains.system().rebuilds + 20);
    }
    return grains.state().words();
  };
  EXPECT_EQ(after(false), after(true));
}

TEST(Surfaces, ThatJumpAwayLeaveNoSpringBehind) {
  GrainModel m = millModel();
  const SurfaceGeometry box = boxOf({0.02, 0.02, 0.01});
  Grains grains(testExec(1), m, {{}, {}, {}, {{box, m.law, placed({0, 0, -0.01})}}},
                {{{0, 0, m.radius - 1e-5}, {0.1, 0, 0}, {}}});
  advance(grains, 10); // a contact lasts 37
  EXPECT_EQ(grains.state().wallBits[0], 1u);
  grains.setSurfacePoses({placed({0, 0, -1})});
  advance(grains, 1);
  EXPECT_EQ(grains.state().wallBits[0], 0u);
}

TEST(Surfaces, NoneCostNothing) {
  const GrainModel m = millModel();
  Grains without(testExec(1), m, {{floorPlane(m.law)}, {}}, millGrains());
  EXPECT_EQ(without.system().constants.features & kSurfaces, 0u);
  EXPECT_EQ(without.system().boundaries.listings(), 0);
  EXPECT_TRUE(without.system().boundaries.surfaceLoads().empty());
  Grains with(testExec(1), m, {{}, {}, {}, {mill(m.law)[0]}}, millGrains());
  EXPECT_EQ(with.system().constants.features & kSurfaces, kSurfaces);
  EXPECT_FALSE(stepKernel(with.system().constants.features, m).general());
}

} // namespace
} // namespace grouser::terrain::testing

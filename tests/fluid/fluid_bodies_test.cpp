// SPDX-License-Identifier: BSD-3-Clause
// Bodies, walls and probes of the particle fluid, and resumed states.
#include "base/error.hpp"
#include "tests/fluid/water.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::fluid {
namespace {

using base::Vec3d;

// --- bodies

/// Archimedes: the mean lift is the weight of the displaced fluid. It acts at the cube's centre, here 0.1 m along x
/// from the origin of the body's frame.
TEST(Fluid, ABodyIsLiftedByTheWeightOfTheFluidItDisplaces) {
  FluidSetup s = cubeInWater(0);
  const Vec3d centre{0.1, 0, 0};
  for (Vec3d& p : s.bodies[0].markers) p += centre;
  s.bodies[0].start.pose.position -= centre;
  Fluid fluid(s, testExec());
  Vec3d force, torque;
  constexpr int kSteps = 300;
  for (int k = 0; k < kSteps; ++k) {
    fluid.step({s.bodies[0].start});
    force += fluid.bodyLoads()[0].force * (1.0 / kSteps), torque += fluid.bodyLoads()[0].torque * (1.0 / kSteps);
  }
  const double weight = s.model.density * 0.4 * 0.4 * 0.4 * kGravity;
  EXPECT_NEAR(force.z / weight, 1, 0.02);
  EXPECT_LT(std::hypot(force.x, force.y), 0.005 * weight);
  EXPECT_NEAR(torque.y / weight, -0.1, 0.002);
  EXPECT_LT(norm(torque - cross(centre, force)), 0.005 * weight * 0.2);
}

/// The energy of the fluid grows by the work of a moving body, and all forces sum to zero.
TEST(Fluid, WorkAndMomentumOfAMovingBodyAreThoseOfTheFluid) {
  FluidSetup s = cubeInWater(0);
  s.model.gravity = {}, s.model.viscosity = 1;
  for (FluidParticle& p : s.particles) p.compression = 0.002;
  Fluid fluid(s, testExec());
  const FluidTotals start = fluid.totals();
  const double dt = s.model.timeStep;
  double work = 0;
  BodyMotion motion = s.bodies[0].start;
  for (int k = 0; k < 200; ++k) {
    const double ramp = std::min(1.0, k / 100.0);
    motion.velocity = Vec3d{0.5, 0, 0.2} * ramp, motion.spin = {0, 0, 0.4 * ramp};
    motion.pose.position += motion.velocity * dt;
    const double half = 0.5 * motion.spin.z * dt;
    motion.pose.orientation = base::Quat{std::cos(half), 0, 0, std::sin(half)} * motion.pose.orientation;
    const auto power = [&] {
      const BodyLoad l = fluid.bodyLoads()[0];
      return dot(l.force, motion.velocity) + dot(l.torque, motion.spin);
    };
    work -= 0.5 * dt * power();
    fluid.step({motion});
    work -= 0.5 * dt * power();
    EXPECT_EQ(fluid.forceBalance(), base::Vec3l{});
  }
  const FluidTotals end = fluid.totals();
  EXPECT_GT(work, 1);
  EXPECT_NEAR(end.total() - start.total(), work, 0.01 * work);
}

/// Two plates under water, 6 x 6 spacings: the upper one approaches the lower at 0.6 m/s, rests on it and
/// rises again. Returns the largest speed of the water over the speed of sound.
double pressWaterBetweenPlates(bool touches) {
  FluidSetup s = tankOfWater();
  const double dx = s.model.spacing;
  FluidBody plate{"plate", {}, {}, touches};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 2; ++k) plate.markers.push_back({(i - 2.5) * dx, (j - 2.5) * dx, (k - 0.5) * dx});
  plate.start.pose = {{0.31, 0.21, 0.125}, {}}; // its lattice is offset from the other's
  s.bodies.push_back(plate);
  plate.start.pose.position = {0.3, 0.2, 0.375};
  s.bodies.push_back(plate);
  std::erase_if(s.particles, [&s](const FluidParticle& p) {
    return std::any_of(s.bodies.begin(), s.bodies.end(), [&p](const FluidBody& b) {
      const Vec3d d = p.position - b.start.pose.position;
      return std::max(std::abs(d.x), std::abs(d.y)) < 0.18 && std::abs(d.z) < 0.07;
    });
  });
  Fluid fluid(s, testExec());
  BodyMotion lower = s.bodies[0].start, upper = s.bodies[1].start;
  double fastest = 0;
  while (fluid.time() < 0.6) {
    const double t = fluid.time(), touch = 0.15 / 0.6;
    upper.velocity.z = t < touch ? -0.6 : t < touch + 0.05 ? 0 : 0.6;
    upper.pose.position.z += upper.velocity.z * s.model.timeStep;
    fluid.step({lower, upper});
    fastest = std::max(fastest, fluid.totals().fastest / s.model.soundSpeed);
  }
  return fastest;
}

/// Touching surfaces leave no room for particles: these enter the plates or move aside, and are not ejected.
TEST(Fluid, WaterBetweenPlatesThatTouchIsNotShotOut) {
  EXPECT_LT(pressWaterBetweenPlates(true), 0.3);
  bool stopped = false;
  double fastest = 0;
  try {
    fastest = pressWaterBetweenPlates(false);
  } catch (const base::SimulationError&) {
    stopped = true;
  }
  EXPECT_TRUE(stopped || fastest > 0.4) << fastest;
}

/// A resumed state is bitwise identical, for any order of particles and any age of lists.
TEST(Fluid, GoesOnFromASavedState) {
  FluidSetup s = cubeInWater(0.3);
  s.model.shifting = 1, s.surfaceDivergence = 2.75;
  BodyMotion motion = s.bodies[0].start;
  const auto next = [&] {
    motion.velocity = {0.3, 0, 0};
    motion.pose.position += motion.velocity * s.model.timeStep;
    return std::vector<BodyMotion>{motion};
  };
  Fluid straight(s, testExec());
  for (int k = 0; k < 37; ++k) straight.step(next());
  FluidSetup later = s;
  later.bodies[0].start = motion;
  Fluid resumed(later, straight.save(), testExec());
  EXPECT_EQ(resumed.hash(), straight.hash());
  EXPECT_EQ(resumed.totals().total(), straight.totals().total());
  for (int k = 0; k < 25; ++k) {
    const std::vector<BodyMotion> now = next();
    straight.step(now), resumed.step(now);
  }
  EXPECT_EQ(resumed.hash(), straight.hash());
  EXPECT_EQ(resumed.steps(), 62);
  later.particles.pop_back();
  EXPECT_THROW(Fluid(later, straight.save(), testExec()), base::InputError);
}

/// Particles, loads of a moving and turning body, and probes: the same bits from both backends.
TEST(Fluid, BodiesAndProbesHaveTheSameBitsOnCuda) {
  if (!base::cudaAvailable()) GTEST_SKIP() << "no CUDA device";
  FluidSetup s = cubeInWater(0.3);
  s.model.viscosity = 0.5;
  Fluid host(s, base::cpuExec(2)), device(s, base::cudaExec());
  BodyMotion motion = s.bodies[0].start;
  for (int k = 0; k < 200; ++k) {
    motion.velocity = {0.004 * k, 0, 0}, motion.acceleration = {1, 0, 0}, motion.spin = {0, 0, 0.002 * k};
    motion.pose.position += motion.velocity * s.model.timeStep;
    host.step({motion}), device.step({motion});
  }
  EXPECT_EQ(host.hash(), device.hash());
  EXPECT_EQ(host.bodyLoads()[0].force, device.bodyLoads()[0].force);
  EXPECT_EQ(host.bodyLoads()[0].torque, device.bodyLoads()[0].torque);
  const std::vector<Vec3d> places{{0, 0.5, 0.1}, {0.5, 0.5, 0.7}};
  EXPECT_EQ(host.pressuresAt(places), device.pressuresAt(places));
  EXPECT_EQ(host.levelsAt(places, 1.0), device.levelsAt(places, 1.0));
}

/// A particle shot at a wall, without fluid around it, returns at the same speed; up to a tenth of the sound
/// speed, opposite a marker or between markers, it never passes the first layer.
TEST(Fluid, NothingPassesAWall) {
  for (const double speed : {0.05, 0.5, 1.0})
    for (const double beside : {0.0, 0.025}) {
      FluidSetup s;
      FluidModel& m = s.model = water(3, 0.05);
      m.timeStep = 1e-4;
      s.markers = wallMarkers(m, [](const Vec3d& p) { return p.z; }, {-0.3, -0.3, -0.2}, {0.3, 0.3, 0.01});
      s.particles = {{{0.025 + beside, 0.025 + beside, 0.1}, {0, 0, -speed}, 0}};
      Fluid fluid(s, testExec());
      double lowest = 1;
      for (int k = 0; k < static_cast<int>(0.25 / (speed * m.timeStep)); ++k) {
        fluid.step();
        lowest = std::min(lowest, fluid.snapshot().position[0].z);
      }
      EXPECT_GT(lowest, -0.025) << speed << " " << beside;
      EXPECT_NEAR(fluid.snapshot().velocity[0].z / speed, 1, 0.01) << speed << " " << beside;
      EXPECT_NEAR(fluid.totals().total(), 0.5 * m.mass() * speed * speed, 0.01 * 0.5 * m.mass() * speed * speed);
    }
}

/// Work against the contact of a plane layer of markers, midway between them, against its closed form: at the fluid's
/// largest compression, c^2 s = 0.3 c^2, no particle penetrates.
TEST(Fluid, TheBarrierOfAWallIsAboveTheGreatestPressure) {
  const auto barrier = [](int dimensions) {
    FluidSetup s;
    const FluidModel& m = s.model = water(dimensions, 0.05);
    const double dx = m.spacing;
    for (const double x : {-1.5, -0.5, 0.5, 1.5})
      for (const double y : {-1.5, -0.5, 0.5, 1.5})
        if (dimensions == 3 || y == 0.5) s.markers.push_back({{x * dx, dimensions == 3 ? y * dx : 0, 0}});
    constexpr int kParts = 200;
    double work = 0;
    for (int k = 0; k < kParts; ++k) {
      s.particles = {{{0, 0, (k + 0.5) / kParts * dx}, {}, 0}};
      const Fluid fluid(s, testExec());
      for (const Vec3d& f : fluid.markerForces()) work -= f.z * dx / kParts;
      EXPECT_EQ(fluid.forceBalance(), base::Vec3l{});
    }
    return work / (m.mass() * m.soundSpeed * m.soundSpeed);
  };
  const double three = 1 - std::sqrt(0.5) / 0.85, two = 1 - 0.5 / 0.7;
  EXPECT_NEAR(barrier(3), 4 * 3 * three * three, 1e-4);
  EXPECT_NEAR(barrier(2), 2 * 3 * two * two, 1e-4);
  EXPECT_GT(barrier(3), kMaxCompression);
  EXPECT_GT(barrier(2), kMaxCompression);
}

/// Contact close to a marker, far beyond the fluid's pair terms: closed form, and exactly opposite forces.
TEST(Fluid, ContactNearAMarkerKeepsItsSize) {
  FluidSetup s;
  const FluidModel& m = s.model = water(3, 0.05);
  s.markers = {{{0, 0, 0}}};
  s.particles = {{{0, 0, 0.1 * m.spacing}, {}, 0}};
  const Fluid fluid(s, testExec());
  const double force = m.mass() * 6 * m.soundSpeed * m.soundSpeed * (0.85 - 0.1) / (0.85 * 0.85 * m.spacing);
  EXPECT_NEAR(-fluid.markerForces()[0].z / force, 1, 1e-5);
  EXPECT_EQ(fluid.forceBalance(), base::Vec3l{});
}

/// A particle at 0.6 spacings from a marker would leave it at 0.72 times the speed of sound, with the potential
/// 3 c^2 (1 - r/r0)^2; the force decreases with its separation speed, so that it stays below half of that speed.
TEST(Fluid, AParticleThatPartsFastFromAMarkerIsPushedLess) {
  FluidSetup s;
  FluidModel& m = s.model = water(3, 0.05);
  m.timeStep = 1e-5;
  s.markers = {{{0, 0, 0}}};
  s.particles = {{{0, 0, 0.6 * m.spacing}, {}, 0}};
  Fluid fluid(s, testExec());
  while (fluid.snapshot().position[0].z < 0.9 * m.spacing) fluid.step();
  const double speed = fluid.snapshot().velocity[0].z / m.soundSpeed;
  EXPECT_GT(speed, 0.2);
  EXPECT_LT(speed, 0.36);
}

// --- probes

/// Pressure and level of still water at a wall, in the middle and above; dry probes.
TEST(Fluid, ProbesReadPressureAndLevel) {
  Fluid fluid(tankOfWater(), testExec());
  const std::vector<double> p =
      fluid.pressuresAt({{0.3, 0.2, 0.2}, {0, 0.2, 0.3}, {0.3, 0.2, 0}, {0.3, 0.2, 0.5}, {0.3, 0.2, 0.8}});
  const double scale = 1000 * kGravity;
  EXPECT_NEAR(p[0], 0.3 * scale, 0.005 * scale);
  EXPECT_NEAR(p[1], 0.2 * scale, 0.005 * scale);
  EXPECT_NEAR(p[2], 0.5 * scale, 0.01 * scale);
  EXPECT_NEAR(p[3], 0, 0.03 * scale);
  EXPECT_EQ(p[4], 0);
  const std::vector<double> level = fluid.levelsAt({{0.3, 0.2, 0}, {0.31, 0.21, -0.01}, {5, 5, 0.1}}, 0.9);
  EXPECT_NEAR(level[0], 0.5, 0.0025);
  EXPECT_NEAR(level[1], 0.5, 0.0025);
  EXPECT_EQ(level[2], 0.1);
}

/// A sheet of water in the air wets a wire over its thickness.
TEST(Fluid, LevelProbesDoNotCountAir) {
  FluidSetup s = tankOfWater();
  std::erase_if(s.particles, [](const FluidParticle& p) { return p.position.z < 0.2; });
  const double sheet = Fluid(s, testExec()).levelsAt({{0.3, 0.2, 0}}, 0.9).front();
  EXPECT_NEAR(sheet, 0.3, 0.05 * s.model.spacing + 0.0025);
}

/// A body motion too fast for the lists is rejected with name and remedy.
TEST(Fluid, ABodyThatOutrunsTheListsIsAFault) {
  FluidSetup s = cubeInWater(0);
  Fluid fluid(s, testExec());
  BodyMotion motion = s.bodies[0].start;
  motion.velocity = {0.2 * s.model.spacing / s.model.timeStep, 0, 0};
  std::string message;
  try {
    fluid.step({motion});
  } catch (const base::SimulationError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("cube moves by up to"), std::string::npos) << message;
  EXPECT_NE(message.find("use a smaller time step"), std::string::npos) << message;
}

} // namespace
} // namespace grouser::fluid

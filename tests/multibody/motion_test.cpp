// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

namespace grouser::multibody::test {
namespace {

const Mat3d kShaftInertia = Mat3d::diagonal({0.3, 0.2, 0.25});

std::string nameOf(JointType type) {
  static const char* const names[] = {"revolute", "spherical",   "universal", "prismatic",
                                      "fixed",    "cylindrical", "distance"};
  return names[static_cast<int>(type)];
}

// ------------------------------------------------------------------------------------------------- every joint type

class EveryJoint : public ::testing::TestWithParam<std::tuple<JointType, Integrator>> {};

/// Two free, tumbling bodies joined by one joint in general position.
Mechanism tumblingPair(JointType type) {
  Mechanism m;
  m.model.addBody(makeBody("A", 2, kShaftInertia, {{0, 0, 0}, {}}, {0.1, -0.2, 0.3}, {0.5, 1.5, -0.7}));
  m.model.addBody(makeBody("B", 1, Mat3d::diagonal({0.1, 0.15, 0.2}),
                           {{0.8, 0.3, -0.2}, frameWithZ({}, {1, 2, 3}).orientation}, {-0.4, 0.1, 0.2},
                           {-1.1, 0.6, 0.9}));
  if (type == JointType::kDistance)
    m.model.addJoint({"joint", type, 0, 1, {{0.2, 0.1, 0}, {}}, {{-0.1, 0.2, 0.1}, {}}});
  else
    m.model.addJointAt("joint", type, 0, 1, frameWithZX({0.4, 0.2, -0.1}, {1, 1, 2}, {1, -1, 0.3}));
  m.start();
  m.loads.gravity = {};
  return m;
}

TEST_P(EveryJoint, DoesNoWorkAndDoesNotDrift) {
  const auto [type, integrator] = GetParam();
  Mechanism m = tumblingPair(type);
  SolverOptions o;
  o.integrator = integrator;
  o.startVelocities = StartVelocities::kAccept;
  Solver solver(m.model, o);
  const int rows[] = {5, 3, 4, 5, 6, 4, 1};
  EXPECT_EQ(solver.degreesOfFreedom(), 12 - rows[static_cast<int>(type)]);
  solver.projectVelocities(m.state, m.loads);
  EXPECT_LT(solver.velocityError(m.state), 1e-14);
  const bool rattling = integrator == Integrator::kRattle;
  // Euler's first step turns the start velocity into a mean: compares with the energy after it.
  const double dt = 1e-3;
  if (!rattling) solver.step(m.state, m.loads, dt);
  const Totals start = totals(m.model, m.state, m.loads);
  double gap = 0, worst = 0, rate = 0;
  for (int i = 0; i < 5000; ++i) {
    solver.step(m.state, m.loads, dt);
    gap = std::max(gap, solver.lastStep().maxPositionError);
    worst = std::max(worst, std::fabs(totals(m.model, m.state, m.loads).kinetic - start.kinetic));
    if (rattling) rate = std::max(rate, solver.velocityError(m.state));
  }
  const Totals end = totals(m.model, m.state, m.loads);
  std::printf("%s, %s: gap %.1e, rate %.1e, energy within %.1e of %.2f J\n", nameOf(type).c_str(),
              rattling ? "rattle" : "euler", gap, rate, worst, start.kinetic);
  EXPECT_LT(gap, rattling ? 5e-15 : 1e-10); // positionTolerance, round-off of coordinates of some metres
  EXPECT_LT(rate, 1e-13);
  EXPECT_LT(worst, (rattling ? 1e-5 : 1e-2) * start.kinetic); // C dt^2, C dt
  EXPECT_LT(length(end.linearMomentum - start.linearMomentum), 1e-12);
  EXPECT_LT(length(end.angularMomentum - start.angularMomentum), rattling ? 1e-12 : 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Types, EveryJoint,
                         ::testing::Combine(::testing::Values(JointType::kRevolute, JointType::kSpherical,
                                                              JointType::kUniversal, JointType::kPrismatic,
                                                              JointType::kFixed, JointType::kCylindrical,
                                                              JointType::kDistance),
                                            ::testing::Values(Integrator::kSymplecticEuler, Integrator::kRattle)),
                         [](const auto& p) {
                           return nameOf(std::get<0>(p.param)) +
                                  (std::get<1>(p.param) == Integrator::kRattle ? "Rattle" : "Euler");
                         });

TEST(Universal, OutputShaftHasTheSpeedOfHookesJoint) {
  // tan(out) = tan(in) cos(beta) up to the quarter turn between the crosses:
  //   w_out / w_in = cos(beta) / (1 - sin^2(beta) cos^2(in)), with the cross's pin on the input in the plane of the
  //   shafts
  // at in = 0.
  const double beta = 0.6, w = 3;
  const Vec3d out{base::cos(beta), 0, base::sin(beta)};
  Mechanism m;
  Drive motor;
  motor.name = "motor", motor.kind = DriveKind::kPosition, motor.law.polynomial = {0, w};
  // Pin on the input along z (in the plane of the shafts), pin on the output along y.
  const double start = base::cos(beta) / (1 - base::sin(beta) * base::sin(beta));
  m.model.addBody(makeBody("input", 1, kShaftInertia, {{-0.5, 0, 0}, {}}, {}, {w, 0, 0}));
  m.model.addBody(makeBody("output", 1, kShaftInertia, {0.5 * out, {}}, {}, start * w * out));
  m.model.addJointAt("bearing in", JointType::kRevolute, kWorld, 0, frameWithZ({-0.5, 0, 0}, {1, 0, 0}));
  m.model.addJointAt("bearing out", JointType::kRevolute, kWorld, 1, frameWithZ(0.5 * out, out));
  m.model.addJointAt("cross", JointType::kUniversal, 0, 1, frameWithZX({}, {0, 0, 1}, {0, 1, 0}));
  m.model.addDrive(motor);
  m.start();
  Solver solver(m.model, rattle());
  EXPECT_EQ(solver.degreesOfFreedom(), 1);
  double worst = 0, torque = 0;
  for (int i = 0; i < 3000; ++i) {
    solver.step(m.state, m.loads, 1e-3);
    const double c = std::cos(w * m.state.time), s = std::sin(beta);
    worst = std::max(worst, std::fabs(m.state.joint[1].rate - w * std::cos(beta) / (1 - s * s * c * c)));
    torque = std::max(torque, std::fabs(driveForce(m.model, m.state, 0)));
  }
  std::printf("Hooke's joint: output speed off by %.1e rad/s, drive torque up to %.3f N m\n", worst, torque);
  EXPECT_LT(worst, 1e-11);
  EXPECT_GT(torque, 0.1); // the output speeds up and slows down twice per turn
}

// ---------------------------------------------------------------------------------------------- cylindrical, bushing

/// A body on a cylindrical joint along z with springs and dampers on slide and angle.
Mechanism screwless(double c) {
  Mechanism m;
  m.model.addBody(makeBody("nut", 2, kShaftInertia, {{0, 0, 0.1}, {base::cos(0.15), 0, 0, base::sin(0.15)}}));
  m.model.addJoint({"bar", JointType::kCylindrical, kWorld, 0, {}, {}, 0.25 * c, 2 * c});
  AxisSpring slide, angle;
  slide.name = "slide", slide.stiffness = 200, slide.axis = JointAxis::kSlide;
  angle.name = "angle", angle.stiffness = 9, angle.axis = JointAxis::kAngle;
  m.model.addAxisSpring(slide);
  m.model.addAxisSpring(angle);
  m.start();
  m.loads.gravity = {};
  return m;
}

TEST(Cylindrical, SlideAndAngleSwingEachWithItsOwnFrequency) {
  // z = 0.1 cos(10 t), angle = 0.3 cos(6 t): sqrt(200 / 2) and sqrt(9 / 0.25).
  for (const Springs springs : {Springs::kExplicit, Springs::kImplicit}) {
    double error[2];
    for (int i = 0; i < 2; ++i) {
      Mechanism m = screwless(0);
      EXPECT_NEAR(axisReading(m.model, m.state, 0, JointAxis::kSlide).position, 0.1, 1e-15);
      EXPECT_NEAR(axisReading(m.model, m.state, 0, JointAxis::kAngle).position, 0.3, 1e-15);
      run(m, rattle(2, springs), i == 0 ? 2e-3 : 1e-3, 2);
      const double z = axisReading(m.model, m.state, 0, JointAxis::kSlide).position,
                   a = axisReading(m.model, m.state, 0, JointAxis::kAngle).position;
      error[i] = std::fabs(z - 0.1 * std::cos(20)) + std::fabs(a - 0.3 * std::cos(12));
      EXPECT_NEAR(axisReading(m.model, m.state, 0, JointAxis::kSlide).springForce, -200 * z, 1e-10);
      EXPECT_NEAR(axisReading(m.model, m.state, 0, JointAxis::kAngle).springForce, -9 * a, 1e-10);
    }
    std::printf("cylindrical with springs: error at 2 s %.2e, %.2e, order %.2f\n", error[0], error[1],
                std::log2(error[0] / error[1]));
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1);
  }
}

TEST(Cylindrical, LimitsHoldOnBothAxes) {
  Mechanism m;
  m.model.addBody(makeBody("nut", 2, kShaftInertia, {}, {0, 0, 3}, {0, 0, 2}));
  m.model.addJoint({"bar", JointType::kCylindrical, kWorld, 0, {}, {}});
  AxisSpring slide, angle;
  slide.name = "slide", slide.axis = JointAxis::kSlide, slide.upperLimit = 0.2, slide.stopStiffness = 1e7;
  angle.name = "angle", angle.axis = JointAxis::kAngle, angle.lowerLimit = -0.1, angle.upperLimit = 0.4;
  angle.stopStiffness = 1e5, angle.stopDamping = 1e3;
  m.model.addAxisSpring(slide);
  m.model.addAxisSpring(angle);
  m.start();
  m.loads.gravity = {};
  Solver solver(m.model, rattle());
  double z = 0, a = 0;
  const double start = energy(m);
  for (int i = 0; i < 300; ++i) {
    solver.step(m.state, m.loads, 1e-3);
    z = std::max(z, m.state.slide[0].position), a = std::max(a, m.state.joint[0].position);
  }
  // Half the slide's impact energy in its stop of 1e7 N/m: 0.2 + 3 sqrt(2 / 1e7); a step of 1 ms may add 3 mm.
  EXPECT_LT(z, 0.2 + 3 * std::sqrt(2 / 1e7) + 3e-3);
  EXPECT_LT(a, 0.4 + 5e-3);
  // The discrete gradient returns the stored energy: the nut rebounds at 3 m/s although omega dt = 2.2; the damped stop
  // dissipates some of the rotation.
  EXPECT_NEAR(m.state.twist[0].v.z, -3, 1e-9);
  EXPECT_LT(m.state.twist[0].w.z, 0);
  EXPECT_GT(m.state.twist[0].w.z, -2);
  EXPECT_NEAR(energy(m) + m.state.ledger.dissipated, start, 1e-9 * start);
}

TEST(Bushing, SixFrequenciesAndLargeRotationsConserveEnergy) {
  Mechanism m;
  m.model.addBody(makeBody("engine", 2, kShaftInertia, {{0.01, -0.02, 0.03}, frameWithZ({}, {0.4, 0.2, 1}).orientation},
                           {}, {0.4, -0.3, 0.8}));
  Bushing b;
  b.name = "mount", b.stiffness = {300, 500, 800}, b.rotationStiffness = {12, 20, 15};
  m.model.addBushing(b);
  m.start();
  m.loads.gravity = {};
  for (const Springs springs : {Springs::kExplicit, Springs::kImplicit}) {
    double drift[2];
    for (int i = 0; i < 2; ++i) {
      m.start();
      m.loads.gravity = {};
      Solver solver(m.model, rattle(2, springs));
      const double start = energy(m), dt = i == 0 ? 4e-3 : 2e-3;
      drift[i] = 0;
      for (int k = 0; k * dt < 5; ++k) {
        solver.step(m.state, m.loads, dt);
        drift[i] = std::max(drift[i], std::fabs(energy(m) - start) / start);
      }
    }
    std::printf("bushing: energy within %.2e, %.2e (order %.2f)\n", drift[0], drift[1], std::log2(drift[0] / drift[1]));
    EXPECT_LT(drift[1], 1e-3);
    EXPECT_NEAR(std::log2(drift[0] / drift[1]), 2, 0.3);
  }
}

TEST(Bushing, StaticDeflectionIsForceOverStiffness) {
  Mechanism m;
  m.model.addBody(makeBody("engine", 2, kShaftInertia, {}));
  Bushing b;
  b.name = "mount", b.stiffness = {300, 500, 800}, b.damping = {30, 40, 50}, b.rotationStiffness = {12, 20, 15};
  b.rotationDamping = {2, 2, 2};
  m.model.addBushing(b);
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    m.start();
    m.loads.gravity = {0, 0, -9.81};
    m.loads.external[0].torque = {0.6, 0, 0};
    SolverOptions o;
    o.integrator = integrator;
    run(m, o, 5e-3, 20);
    EXPECT_NEAR(m.state.bushing[0].translation.z, -2 * 9.81 / 800, 1e-9);
    EXPECT_NEAR(m.state.bushing[0].rotation.x, 0.6 / 12, 1e-9);
    EXPECT_NEAR(m.state.bushing[0].force.z, 2 * 9.81, 1e-6);
    EXPECT_NEAR(m.state.bushing[0].torque.x, -0.6, 1e-6);
  }
}

// ------------------------------------------------------------------------------------------------- imposed motions

/// A slider-crank in the x-z plane; the crank turns about y; crank 0.1 m, rod 0.3 m.
Mechanism sliderCrank(const Drive& drive, double crankRate) {
  Mechanism m;
  const double r = 0.1, l = 0.3;
  const double v = crankRate * r;
  m.model.addBody(makeBody("crank", 1, kShaftInertia, {{0, 0, r}, {}}, {v, 0, 0}, {0, crankRate, 0}));
  const double slope = std::sqrt(l * l - r * r);
  const Vec3d end{slope, 0, 0}, pin{0, 0, r};
  // Crank upright: the rod only slides along x.
  addRod(m.model, "rod", pin, end, {v, 0, 0});
  m.model.addBody(makeBody("piston", 2, kShaftInertia, {end, {}}, {v, 0, 0}));
  m.model.addJointAt("crank pin", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  m.model.addJointAt("big end", JointType::kRevolute, 0, 1, frameWithZ(pin, kY));
  m.model.addJointAt("small end", JointType::kSpherical, 1, 2, frameWithZ(end, kY));
  m.model.addJointAt("cylinder", JointType::kPrismatic, kWorld, 2, frameWithZ(end, {1, 0, 0}));
  m.model.addDrive(drive);
  m.start();
  return m;
}

TEST(ImposedMotion, PositionLawIsMetInPositionAndRateWithoutDrift) {
  Drive d;
  d.name = "motor", d.joint = 0, d.kind = DriveKind::kPosition;
  d.law.polynomial = {0, 4};
  d.law.harmonics = {{0.5, 7, 0}};
  Mechanism m = sliderCrank(d, d.law.rate(0));
  Solver solver(m.model, rattle());
  EXPECT_EQ(solver.degreesOfFreedom(), 1);
  double position = 0, rate = 0, slide = 0, work = 0, power = drivePower(m.model, m.state, 0);
  const double dt = 1e-3, start = energy(m);
  for (int i = 0; i < 5000; ++i) {
    solver.step(m.state, m.loads, dt);
    const double t = m.state.time, a = m.state.joint[0].position;
    position = std::max(position, std::fabs(a - d.law.value(t)));
    rate = std::max(rate, std::fabs(m.state.joint[0].rate - d.law.rate(t)));
    // Closed form of the piston's position.
    const double x = 0.1 * std::sin(a) + std::sqrt(0.09 - 0.01 * std::cos(a) * std::cos(a));
    slide = std::max(slide, std::fabs(m.state.pose[2].position.x - x));
    const double now = drivePower(m.model, m.state, 0);
    if (i > 0) work += 0.5 * dt * (power + now);
    power = now;
  }
  std::printf("position law: position off by %.1e rad, rate %.1e rad/s, piston %.1e m\n", position, rate, slide);
  EXPECT_LT(position, 1e-12);
  EXPECT_LT(rate, 1e-12);
  EXPECT_LT(slide, 1e-12);
  EXPECT_NEAR(energy(m) - start, m.state.ledger.driveWork, 1e-3);
  EXPECT_NEAR(work, m.state.ledger.driveWork, 2e-2); // the first step has no previous power
}

TEST(ImposedMotion, DriveTorqueIsThatOfInverseDynamics) {
  // A single wheel: torque = I alpha(t), exactly.
  Mechanism m;
  Drive d;
  d.name = "motor", d.kind = DriveKind::kPosition;
  d.law.harmonics = {{0.7, 3, 0}};
  m.model.addBody(makeBody("wheel", 1, kShaftInertia, {}, {}, {0, 0, d.law.rate(0)}));
  m.model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
  m.model.addDrive(d);
  m.start();
  Solver solver(m.model, rattle());
  for (int i = 0; i < 1000; ++i) {
    solver.step(m.state, m.loads, 1e-3);
    ASSERT_NEAR(driveForce(m.model, m.state, 0), 0.25 * d.law.acceleration(m.state.time), 1e-11);
  }
}

TEST(ImposedMotion, SpeedLawLeadsToItsIntegralWithBothIntegrators) {
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    Drive d;
    d.name = "motor";
    d.law.ramps = {{0, 1, 2}, {0, 5, 5}};
    Mechanism m;
    m.model.addBody(makeBody("wheel", 1, kShaftInertia, {}));
    m.model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
    m.model.addDrive(d);
    m.start();
    SolverOptions o;
    o.integrator = integrator;
    run(m, o, 1e-3, 3);
    EXPECT_NEAR(m.state.joint[0].position, 12.5, 1e-10);
    EXPECT_NEAR(m.state.joint[0].rate, 5, 1e-9);
  }
}

TEST(ImposedMotion, ABlowAtTheStartIsInTheLedgerOnce) {
  // A wheel at rest, driven at 4 rad/s from the first step: the drive's work equals the kinetic energy.
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    Mechanism m;
    Drive d;
    d.name = "motor", d.speed = 4;
    m.model.addBody(makeBody("wheel", 1, kShaftInertia, {}));
    m.model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
    m.model.addDrive(d);
    m.start();
    SolverOptions o;
    o.integrator = integrator;
    o.startVelocities = StartVelocities::kAccept;
    run(m, o, 1e-2, 0.1);
    EXPECT_NEAR(m.state.ledger.driveWork, 0.5 * 0.25 * 16, 1e-12);
    EXPECT_NEAR(totals(m.model, m.state, m.loads).kinetic, 2, 1e-12);
  }
}

TEST(ImposedMotion, TorqueLawSpinsUpAWheel) {
  Drive d;
  d.name = "motor", d.kind = DriveKind::kForce, d.law.polynomial = {1, 2};
  Mechanism m;
  m.model.addBody(makeBody("wheel", 1, kShaftInertia, {}));
  m.model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
  m.model.addDrive(d);
  m.start();
  run(m, rattle(), 1e-2, 1);
  EXPECT_NEAR(m.state.joint[0].rate, (1 + 1) / 0.25, 1e-12); // the trapezium is exact for a line
  EXPECT_NEAR(driveForce(m.model, m.state, 0), 3, 1e-12);
  EXPECT_NEAR(drivePower(m.model, m.state, 0), 3 * 8, 1e-11);
  EXPECT_NEAR(m.state.ledger.driveWork, totals(m.model, m.state, m.loads).kinetic, 1e-2);
}

} // namespace
} // namespace grouser::multibody::test

// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace grouser::multibody::test {
namespace {

class Couplings : public ::testing::TestWithParam<Integrator> {};

TEST_P(Couplings, GearedWheelsTurnInTheirRatioAndShareTheTorque) {
  // A torque on wheel 1 with ratio -2: reduced inertia I1 + 4 I2; force on axis 2 = I2 alpha2.
  Mechanism m;
  m.model.addBody(makeBody("one", 1, kWheelInertia, {}));
  m.model.addBody(makeBody("two", 1, Mat3d::diagonal({0.1, 0.1, 0.1}), {{1, 0, 0}, {}}));
  m.model.addJointAt("hub 1", JointType::kRevolute, kWorld, 0, {});
  m.model.addJointAt("hub 2", JointType::kRevolute, kWorld, 1, {{1, 0, 0}, {}});
  Coupling gears;
  gears.name = "gears", gears.joint1 = 0, gears.joint2 = 1, gears.ratio = -2;
  m.model.addCoupling(gears);
  m.start();
  m.loads.external[0].torque = {0, 0, 1.3};
  SolverOptions o;
  o.integrator = GetParam();
  Solver solver(m.model, o);
  EXPECT_EQ(solver.degreesOfFreedom(), 1);
  const int n = 1000;
  for (int i = 0; i < n; ++i) solver.step(m.state, m.loads, 1e-3);
  const double alpha = 1.3 / (0.25 + 4 * 0.1);
  EXPECT_NEAR(m.state.twist[0].w.z, alpha, 1e-10);
  EXPECT_NEAR(m.state.twist[1].w.z, -2 * alpha, 1e-10);
  EXPECT_NEAR(m.state.joint[1].position + 2 * m.state.joint[0].position, 0, 1e-10);
  EXPECT_NEAR(m.state.coupling[0].force, -2 * alpha * 0.1, 1e-8);
}

TEST_P(Couplings, ADrivesTorqueIsPartOfItsJointsACouplingsForceStandsBesideThem) {
  Mechanism m;
  m.model.addBody(makeBody("one", 1, kWheelInertia, {}));
  m.model.addBody(makeBody("two", 1, Mat3d::diagonal({0.1, 0.1, 0.1}), {{1, 0, 0}, {}}));
  m.model.addJointAt("hub 1", JointType::kRevolute, kWorld, 0, {});
  m.model.addJointAt("hub 2", JointType::kRevolute, kWorld, 1, {{1, 0, 0}, {}});
  Coupling gears;
  gears.name = "gears", gears.joint1 = 0, gears.joint2 = 1, gears.ratio = -2;
  m.model.addCoupling(gears);
  Drive motor;
  motor.name = "motor", motor.joint = 0, motor.kind = DriveKind::kForce, motor.law = TimeLaw::constant(1.3);
  m.model.addDrive(motor);
  m.start();
  SolverOptions o;
  o.integrator = GetParam();
  Solver solver(m.model, o);
  for (int i = 0; i < 10; ++i) solver.step(m.state, m.loads, 1e-3);
  // I_1 alpha_1 = torque of hub 1 + 2 x force of the gears on hub 2; only this force turns wheel 2.
  const double alpha = 1.3 / (0.25 + 4 * 0.1);
  EXPECT_NEAR(m.state.joint[0].torque.z, 1.3, 1e-12);
  EXPECT_NEAR(m.state.joint[0].torque.z + 2 * m.state.coupling[0].force, 0.25 * alpha, 1e-9);
  EXPECT_NEAR(m.state.joint[1].torque.z, 0, 1e-12);
  EXPECT_NEAR(m.state.coupling[0].force, -2 * alpha * 0.1, 1e-9);
}

/// Three wheels on separate axles with couplings {first, second, ratio}.
struct Mesh {
  int first, second;
  double ratio;
};
Model wheels(const std::vector<Mesh>& meshes) {
  Model model;
  for (int i = 0; i < 3; ++i) {
    const Pose place{{1.0 * i, 0, 0}, {}};
    model.addBody(makeBody("wheel " + std::to_string(i), 1, kWheelInertia, place));
    model.addJointAt("hub " + std::to_string(i), JointType::kRevolute, kWorld, i, place);
  }
  for (const Mesh& m : meshes) {
    Coupling c;
    c.name = "mesh " + std::to_string(model.couplings().size());
    c.joint1 = m.first, c.joint2 = m.second, c.ratio = m.ratio;
    model.addCoupling(c);
  }
  return model;
}

std::string errorOf(const Model& model) {
  try {
    const Solver solver(model);
  } catch (const base::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(CouplingCheck, RatiosThatContradictEachOtherAreRefusedWithTheNamesOfAll) {
  // Two ratios for two wheels; loops of three; the last ratio is not the product of the others, one of them reversed.
  EXPECT_EQ(errorOf(wheels({{0, 1, -2}, {0, 1, 3}})),
            "coupling 'mesh 1': joint 'hub 1' cannot move 3 times as far as joint 'hub 0': with 'mesh 0' it moves "
            "-2 times as far; remove one of them, or correct a ratio");
  EXPECT_NE(errorOf(wheels({{0, 1, -2}, {1, 2, -3}, {0, 2, 5}}))
                .find("coupling 'mesh 2': joint 'hub 2' cannot move 5 times as far as joint 'hub 0': with 'mesh 0', "
                      "'mesh 1' it moves 6 times as far"),
            std::string::npos);
  EXPECT_NE(errorOf(wheels({{0, 1, -2}, {2, 1, -4}, {0, 2, 5}})).find("with 'mesh 0', 'mesh 1' it moves 0.5 times"),
            std::string::npos);
}

TEST(CouplingCheck, OnlyThoseThatContradictAreNamed) {
  const std::string error = errorOf(wheels({{1, 2, -3}, {0, 1, -2}, {0, 1, 3}}));
  EXPECT_NE(error.find("coupling 'mesh 2'"), std::string::npos) << error;
  EXPECT_NE(error.find("with 'mesh 1' it moves"), std::string::npos) << error;
  EXPECT_EQ(error.find("mesh 0"), std::string::npos) << error;
}

TEST(CouplingCheck, AWheelThatOtherJointsHoldIsNamedWhereItLocksATrain) {
  Model model = wheels({{0, 1, -2}, {1, 2, -3}});
  model.addJointAt("weld", JointType::kFixed, kWorld, 2, {{2.5, 0, 0}, {}});
  const std::string error = errorOf(model);
  EXPECT_NE(error.find("coupling 'mesh 1': the axis of joint 'hub 2' is locked by other joints"), std::string::npos)
      << error;
}

TEST(CouplingCheck, ATrainThatAgreesWithItselfIsTaken) {
  const auto freedom = [](const std::vector<Mesh>& meshes) {
    const Model model = wheels(meshes);
    return Solver(model).degreesOfFreedom();
  };
  EXPECT_EQ(freedom({{0, 1, -2}, {0, 1, -2}}), 2);
  EXPECT_EQ(freedom({{0, 1, -2}, {1, 2, -3}, {0, 2, 6}}), 1);
  EXPECT_EQ(freedom({{0, 1, 1e-3}, {1, 2, 1e-3}}), 1) << "a reduction by a million does not lock";
}

TEST_P(Couplings, ScrewTurnsAngleIntoSlide) {
  // A nut on a cylindrical joint, slide = pitch / (2 pi) angle, falls: a = g / (1 + I / (m p^2)).
  const double p = 0.02;
  Mechanism m;
  m.model.addBody(makeBody("nut", 2, kWheelInertia, {}));
  m.model.addJoint({"bar", JointType::kCylindrical, kWorld, 0, {}, {}});
  Coupling screw;
  screw.name = "thread", screw.ratio = p, screw.axis1 = JointAxis::kAngle, screw.axis2 = JointAxis::kSlide;
  m.model.addCoupling(screw);
  m.start();
  SolverOptions o;
  o.integrator = GetParam();
  Solver solver(m.model, o);
  const double dt = 1e-3;
  const int n = 2000;
  for (int i = 0; i < n; ++i) solver.step(m.state, m.loads, dt);
  const double a = -9.81 / (1 + 0.25 / (2 * p * p));
  EXPECT_NEAR(m.state.slide[0].rate, a * n * dt, 1e-9);
  EXPECT_NEAR(m.state.slide[0].position, p * m.state.joint[0].position, 1e-10);
}

TEST(CouplingForce, IsThatOfTheMotionAlsoOnATurningArm) {
  // A nut that must spin to slide outwards on a rotating arm: (m + I / p^2) r'' = m w^2 r; the thread's force m (r'' -
  // w^2 r).
  const double p = 0.3, w = 2, r0 = 0.5, mass = 2, I = 0.25;
  Mechanism m;
  m.model.addBody(makeBody("arm", 1, kWheelInertia, {}, {}, {0, 0, w}));
  m.model.addBody(makeBody("nut", mass, Mat3d::diagonal({I, I, I}), {{r0, 0, 0}, {}}, {0, w * r0, 0}, {0, 0, w}));
  m.model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
  m.model.addJointAt("thread", JointType::kCylindrical, 0, 1, frameWithZ({r0, 0, 0}, {1, 0, 0}));
  Coupling screw;
  screw.name = "screw", screw.joint1 = screw.joint2 = 1, screw.ratio = p;
  screw.axis1 = JointAxis::kAngle, screw.axis2 = JointAxis::kSlide;
  m.model.addCoupling(screw);
  Drive motor;
  motor.name = "motor", motor.speed = w;
  m.model.addDrive(motor);
  m.start();
  m.loads.gravity = {};
  Solver solver(m.model, rattle(4));
  for (int i = 0; i < 200; ++i) {
    solver.step(m.state, m.loads, 5e-3);
    const double r = r0 + m.state.slide[1].position, outwards = w * w * r * mass / (mass + I / (p * p));
    ASSERT_NEAR(m.state.coupling[0].force, mass * (outwards - w * w * r), 1e-10) << i;
  }
  const double rate = w * std::sqrt(mass / (mass + I / (p * p)));
  EXPECT_NEAR(r0 + m.state.slide[1].position, r0 * std::cosh(rate), 1e-8);
}

TEST_P(Couplings, FourBodiesFeelNoNetForceOrTorque) {
  // Two free pairs, each on a revolute, geared together: linear momentum is constant, and each pair's own reactions
  // cancel.
  Mechanism m;
  for (int i = 0; i < 4; ++i)
    m.model.addBody(makeBody("body " + std::to_string(i), 1 + i, kWheelInertia, {{1.0 * i, 0, 0}, {}}));
  m.model.addJointAt("pin 1", JointType::kRevolute, 0, 1, {{0.5, 0, 0}, {}});
  m.model.addJointAt("pin 2", JointType::kRevolute, 2, 3, frameWithZ({2.5, 0, 0}, {0, 1, 1}));
  Coupling belt;
  belt.name = "belt", belt.joint1 = 0, belt.joint2 = 1, belt.ratio = 1.7;
  m.model.addCoupling(belt);
  m.start();
  m.loads.gravity = {};
  m.loads.external[0].torque = {0, 0, 2};
  m.loads.external[1].torque = {0, 0, -2};
  SolverOptions o;
  o.integrator = GetParam();
  Solver solver(m.model, o);
  double gap = 0;
  for (int i = 0; i < 2000; ++i) {
    solver.step(m.state, m.loads, 1e-3);
    gap = std::max(gap, std::fabs(m.state.joint[1].position - 1.7 * m.state.joint[0].position));
  }
  EXPECT_LT(gap, 1e-10);
  EXPECT_GT(std::fabs(m.state.joint[0].position), 1);
  const Totals t = totals(m.model, m.state, m.loads);
  EXPECT_LT(length(t.linearMomentum), 1e-11);
  EXPECT_LT(length(t.angularMomentum), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Both, Couplings, ::testing::Values(Integrator::kSymplecticEuler, Integrator::kRattle),
                         [](const auto& p) { return p.param == Integrator::kRattle ? "Rattle" : "Euler"; });

} // namespace
} // namespace grouser::multibody::test

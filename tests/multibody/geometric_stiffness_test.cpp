// SPDX-License-Identifier: BSD-3-Clause
// Oscillations across the tension of joints and springs: closed-form frequencies, and stable steps.
#include "base/error.hpp"
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace grouser::multibody::test {
namespace {

/// The power iteration stops at a growth below 1e-5 per iteration: the eigenvalue may be larger by a hundredth.
constexpr double kRateError = 0.01;

SolverOptions scheme(Integrator integrator) {
  SolverOptions o = rattle(2, Springs::kImplicit);
  o.integrator = integrator;
  return o;
}

double rateOf(const Mechanism& m, std::string* part = nullptr) {
  return Solver(m.model, rattle(2, Springs::kImplicit)).geometricStiffnessRate(m.state, m.loads, part);
}

/// Point masses at equal distances `pitch` on the x axis, joined by distance joints, or by springs under tension; the
/// last is tied to a slider under the force `force`.
Mechanism beadedString(int beads, double mass, double pitch, double force, bool springs) {
  Mechanism m;
  for (int i = 0; i < beads; ++i) {
    Body bead = makeBody("bead " + std::to_string(i), mass, {}, {{pitch * (i + 1), 0, 0}, {}});
    bead.point = true;
    m.model.addBody(bead);
  }
  const Vec3d end{pitch * (beads + 1), 0, 0};
  m.model.addBody(makeBody("slider", 1, pointInertia(1), {end, {}}));
  m.model.addJointAt("rail", JointType::kPrismatic, kWorld, beads, frameWithZ(end, {1, 0, 0}));
  for (int i = 0; i <= beads; ++i) {
    const std::string name = std::to_string(i);
    if (!springs) {
      m.model.addJoint({"rod " + name, JointType::kDistance, i == 0 ? kWorld : i - 1, i, {}, {}});
      continue;
    }
    PointSpring s;
    s.name = "cord " + name, s.bodyA = i == 0 ? kWorld : i - 1, s.bodyB = i;
    s.stiffness = 1e3 * force / pitch, s.restLength = pitch * (1 - 1e-3);
    m.model.addPointSpring(s);
  }
  m.start();
  m.loads.gravity = {};
  m.loads.external[static_cast<std::size_t>(beads)].force = {force, 0, 0};
  return m;
}

TEST(GeometricStiffness, TautStringOfBeadsSwingsAsItsClosedFormSays) {
  // Highest of the N modes: omega^2 = 2 T / (m l) (1 - cos(pi N / (N + 1))).
  for (const bool springs : {false, true})
    for (const double force : {1e-3, 1e2, 1e7})
      for (const double mass : {1e-3, 1.0, 1e3})
        for (const int beads : {1, 2, 9}) {
          const double pitch = 0.3;
          const double omega =
              std::sqrt(2 * force / (mass * pitch) * (1 - base::cos(base::kPi * beads / (beads + 1.0))));
          const double rate = rateOf(beadedString(beads, mass, pitch, force, springs));
          EXPECT_NEAR(rate, omega, kRateError * omega) << springs << ' ' << force << ' ' << mass << ' ' << beads;
        }
}

/// A rod of 0.8 m, on a revolute at its end, at rest below it or, if `upright`, above it.
Mechanism rodWithWeight(double weight, bool upright) {
  Mechanism m;
  const double z = upright ? 0.4 : -0.4;
  m.model.addBody(makeBody("rod", 2, Mat3d::diagonal({0.1, 0.11, 0.01}), {{0, 0, z}, {}}));
  Body tip = makeBody("weight", weight, {}, {{0, 0, 2 * z}, {}});
  tip.point = true;
  m.model.addBody(tip);
  m.model.addJointAt("pivot", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  m.model.addJointAt("hook", JointType::kSpherical, 0, 1, {{0, 0, 2 * z}, {}});
  m.start();
  return m;
}

TEST(GeometricStiffness, PendulumSwingsAndAnUprightOneFallsAtTheSameRate) {
  // omega^2 = g (m l / 2 + M l) / (I + m l^2 / 4 + M l^2); one mode, so that only the derivative's error remains.
  for (const double weight : {1e-3, 1.0, 1e6}) {
    const double expected = std::sqrt(9.81 * (2 * 0.4 + weight * 0.8) / (0.11 + 2 * 0.16 + weight * 0.64));
    for (const bool upright : {false, true})
      EXPECT_NEAR(rateOf(rodWithWeight(weight, upright)), expected, 1e-6 * expected) << weight << upright;
  }
}

/// Ten links under a weight, suspended, slightly off the vertical.
Mechanism chainWithWeight(double weight) {
  const int n = 10;
  const double l = 0.15;
  Mechanism m;
  for (int i = 0; i < n; ++i)
    m.model.addBody(makeBody("link " + std::to_string(i), 1, Mat3d::diagonal({0.002, 0.002, 0.0002}),
                             {{0, 0, -l * (i + 0.5)}, {}}));
  Body tip = makeBody("weight", weight, {}, {{0, 0, -l * n}, {}});
  tip.point = true;
  m.model.addBody(tip);
  for (int i = 0; i < n; ++i)
    m.model.addJointAt("pin " + std::to_string(i), JointType::kRevolute, i - 1, i, frameWithZ({0, 0, -l * i}, kY));
  m.model.addJointAt("hook", JointType::kSpherical, n - 1, n, {{0, 0, -l * n}, {}});
  m.start();
  m.loads.gravity = {9.81e-3, 0, -9.81};
  return m;
}

TEST(GeometricStiffness, ChainBearsStepsUpToTheStatedOneAndNoLongerOnes) {
  for (const double weight : {1.0, 1e2, 1e4, 1e6})
    for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle})
      for (const double share : {0.95, 1.05}) {
        Mechanism m = chainWithWeight(weight);
        Solver solver(m.model, scheme(integrator));
        const double dt = share * solver.stabilityLimit() / solver.geometricStiffnessRate(m.state, m.loads);
        // It swings as a whole to twice the 1 mrad of inclined gravity; an instability bends the pins.
        double widest = 0;
        try {
          for (int i = 0; i < 3000 && widest < 0.01; ++i) {
            solver.step(m.state, m.loads, dt);
            for (const JointReading& pin : m.state.joint) widest = std::max(widest, std::fabs(pin.position));
          }
        } catch (const base::SimulationError&) {
          widest = base::kPi;
        }
        if (share < 1)
          EXPECT_LT(widest, 2.5e-3) << weight;
        else
          EXPECT_GE(widest, 0.01) << weight;
      }
}

TEST(GeometricStiffness, NamesWhatIsUnderTensionAndIsZeroWithoutForces) {
  std::string part = "left as it was";
  Mechanism slack = beadedString(3, 1, 0.3, 0, false);
  EXPECT_EQ(rateOf(slack, &part), 0);
  EXPECT_EQ(part, "");
  // The light bead has the highest frequency; rods 1 and 2 hold it.
  Mechanism m;
  for (int i = 0; i < 3; ++i) {
    Body bead = makeBody("bead " + std::to_string(i), i == 1 ? 0.01 : 1, {}, {{0, 0, -0.3 * (i + 1)}, {}});
    bead.point = true;
    m.model.addBody(bead);
  }
  for (int i = 0; i < 3; ++i)
    m.model.addJoint({"rod " + std::to_string(i), JointType::kDistance, i == 0 ? kWorld : i - 1, i, {}, {}});
  m.start();
  rateOf(m, &part);
  EXPECT_EQ(part, "joint 'rod 1'"); // it carries more than rod 2
}

} // namespace
} // namespace grouser::multibody::test

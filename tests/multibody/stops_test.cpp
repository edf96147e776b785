// SPDX-License-Identifier: BSD-3-Clause
// End stops: restitution, accuracy, and dependence on the step.
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::multibody::test {
namespace {

double energyOf(const Mechanism& p) {
  const Totals t = totals(p.model, p.state, p.loads);
  return t.kinetic + t.gravity + t.elastic;
}

SolverOptions rattle(int order = 2) {
  SolverOptions o;
  o.integrator = Integrator::kRattle, o.order = order, o.springs = Springs::kImplicit;
  return o;
}

/// A slider that falls onto a stop.
Mechanism bouncingSlider(double stiffness, double damping) {
  Mechanism p;
  p.model.addBody(makeBody("slider", 2, Mat3d::diagonal({0.1, 0.1, 0.1}), {{0, 0, 0}, {}}));
  p.model.addJointAt("rail", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {0, 0, 1}));
  AxisSpring stop;
  stop.name = "stop", stop.joint = 0, stop.lowerLimit = -0.1, stop.stopStiffness = stiffness,
  stop.stopDamping = damping;
  p.model.addAxisSpring(stop);
  p.start();
  return p;
}

/// A double pendulum with a stop on its upper rod, so that the row rotates and effective masses change.
Mechanism bouncingPendulum(double stiffness) {
  Mechanism p;
  p.model.addBody(makeBody("rod", 1, Mat3d::diagonal({0.01, 0.08, 0.08}), {{0.5, 0, 0}, {}}));
  p.model.addBody(makeBody("bob", 0.5, Mat3d::diagonal({0.01, 0.02, 0.02}), {{1.25, 0, 0}, {}}));
  p.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({0, 0, 0}, kY));
  p.model.addJointAt("elbow", JointType::kRevolute, 0, 1, frameWithZ({1, 0, 0}, kY));
  AxisSpring stop;
  stop.name = "stop", stop.joint = 0, stop.lowerLimit = -1, stop.upperLimit = 1, stop.stopStiffness = stiffness;
  p.model.addAxisSpring(stop);
  AxisSpring second = stop;
  second.name = "elbow stop", second.joint = 1, second.lowerLimit = -0.4, second.upperLimit = 0.4;
  p.model.addAxisSpring(second);
  p.start();
  return p;
}

/// Largest energy change over so many bounces at the stop of joint 0 [J].
double energyChange(Mechanism p, double dt, int bounces, double until) {
  Solver solver(p.model, rattle());
  const double start = energyOf(p);
  double worst = 0, before = 0;
  while (bounces > 0 && p.state.time < until) {
    solver.step(p.state, p.loads, dt);
    const double now = p.state.joint[0].springForce;
    if (now != 0 && before == 0) --bounces;
    before = now;
    worst = std::max(worst, std::fabs(energyOf(p) - start));
  }
  EXPECT_TRUE(bounces == 0 || p.state.time >= until);
  return worst;
}

TEST(MultibodyStops, SliderReturnsItsEnergyOverAThousandBouncesAtAnyStep) {
  // omega dt from 0.2 to 7: the stop's force is a discrete gradient of its energy, and nothing else is stiff.
  // Round-off of up to 5e5 steps, 2e-15 of 2 J each (measured 1e-10 J).
  for (const auto& [stiffness, dt] : {std::pair{1e4, 1e-2}, {1e4, 3e-3}, {1e6, 1e-2}, {1e6, 1e-3}})
    EXPECT_LT(energyChange(bouncingSlider(stiffness, 0), dt, 1000, 1e9), 2e-9) << stiffness << " " << dt;
}

TEST(MultibodyStops, DoublePendulumBetweenStopsHoldsItsEnergyToSecondOrder) {
  // Rows rotate and masses change during contact; the motion is chaotic. Measured 9e3 dt^2 to 1.3e4 dt^2 [J].
  for (const double dt : {1e-3, 5e-4, 2.5e-4})
    EXPECT_LT(energyChange(bouncingPendulum(1e4), dt, 1000, 30), 3e4 * dt * dt) << dt;
}

TEST(MultibodyStops, BouncesKeepTimeToSecondOrder) {
  // Between two stops of stiffness k a slider travels for L / v, and each bounce lasts pi / omega.
  const double mass = 2, k = 1e4, v = 0.7, omega = std::sqrt(k / mass), half = 0.1;
  const double flight = 2 * half / v, bounce = base::kPi / omega, end = 7.31;
  double rest = end - half / v, side = 1;
  while (rest > flight + bounce) rest -= flight + bounce, side = -side;
  ASSERT_GT(rest, bounce) << "ends in flight";
  const double exact = side * (half - v * (rest - bounce));
  for (const int steps : {1462, 2924, 5848, 11696}) {
    Mechanism p;
    p.model.addBody(makeBody("slider", mass, Mat3d::diagonal({0.1, 0.1, 0.1}), {{0, 0, 0}, {}}, {0, 0, v}));
    p.model.addJointAt("rail", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {0, 0, 1}));
    AxisSpring stop;
    stop.name = "stops", stop.joint = 0, stop.lowerLimit = -half, stop.upperLimit = half, stop.stopStiffness = k;
    p.model.addAxisSpring(stop);
    p.start();
    p.loads.gravity = {};
    Solver solver(p.model, rattle());
    const double dt = end / steps;
    for (int i = 0; i < steps; ++i) solver.step(p.state, p.loads, dt);
    // 22 bounces; the midpoint rule extends each by pi / omega (omega dt)^2 / 12, of 15 mm altogether, and the
    // first and last step of a contact shift it by as much.
    EXPECT_NEAR(p.state.joint[0].position, exact, 22 * v * bounce * (omega * dt) * (omega * dt) / 6 + 1e-12) << steps;
    EXPECT_NEAR(std::fabs(p.state.joint[0].rate), v, 1e-12 * steps);
  }
}

SolverOptions symplecticEuler() {
  SolverOptions o;
  o.integrator = Integrator::kSymplecticEuler;
  return o;
}

/// Restitution of a slider of 2 kg at a stop, and the largest attraction of the stop [N].
struct Bounce {
  double restitution, pull;
};
Bounce bounceOff(const SolverOptions& options, double stiffness, double damping, double dt, double phase) {
  Mechanism p = bouncingSlider(stiffness, damping);
  setTwist(p.model, p.state, 0, {{0, 0, -1}, {}});
  p.loads.gravity = {};
  p.state.pose[0].position.z = p.state.joint[0].position = -0.1 + (2 + phase) * dt;
  Solver solver(p.model, options);
  Bounce bounce{};
  const double omega = std::sqrt(stiffness / 2);
  for (int i = 0; i < static_cast<int>(7 / (omega * dt)); ++i) {
    solver.step(p.state, p.loads, dt);
    bounce.pull = std::max(bounce.pull, -p.state.joint[0].springForce);
  }
  EXPECT_EQ(p.state.joint[0].springForce, 0);
  bounce.restitution = p.state.joint[0].rate;
  return bounce;
}

/// Spring and damper without attraction release where k x + c x' = 0:
///   e = exp(-2 zeta acos(zeta) / sqrt(1 - zeta^2)),   zeta = c / (2 sqrt(k m))
/// (Schwager and Poeschel 2007, Granular Matter 9:465).
double restitutionOf(double zeta) { return std::exp(-2 * zeta * std::acos(zeta) / std::sqrt(1 - zeta * zeta)); }

TEST(MultibodyStops, DampedStopGivesBackTheClosedFormOfItsRestitution) {
  const double mass = 2, k = 1e6, omega = std::sqrt(k / mass);
  struct Case {
    SolverOptions options;
    int order;
    double share; ///< bound of the error over (omega dt)^order; more than twice the measured one
  };
  for (const auto& [options, order, share] : {Case{rattle(), 2, 1.0}, Case{symplecticEuler(), 1, 1.5}})
    for (const double zeta : {0.05, 0.3, 0.8}) {
      double error[2]{};
      for (int fine = 0; fine < 2; ++fine)
        for (int phase = 0; phase < 8; ++phase) { // worst case over the phase of first contact
          const double dt = (fine ? 0.01 : 0.02) / omega;
          const Bounce b = bounceOff(options, k, 2 * zeta * mass * omega, dt, phase / 8.0);
          error[fine] = std::max(error[fine], std::fabs(b.restitution - restitutionOf(zeta)));
          EXPECT_LE(b.pull, 1e-9 * k * 1 / omega) << "round-off of the largest force; zeta " << zeta;
        }
      EXPECT_LT(error[0], share * std::pow(0.02, order)) << zeta << " order " << order;
      EXPECT_LT(error[1], share * std::pow(0.01, order)) << zeta << " order " << order;
    }
}

TEST(MultibodyStops, BothIntegratorsGiveTheWorkedExample) {
  // k 1e5 N/m, c 200 N s/m, m 2 kg: e = 0.53942; damping only on entry would yield its square root, 0.7345.
  EXPECT_NEAR(restitutionOf(200 / (2 * std::sqrt(1e5 * 2))), 0.53942, 5e-6);
  for (const SolverOptions& options : {rattle(), rattle(4), symplecticEuler()})
    EXPECT_NEAR(bounceOff(options, 1e5, 200, 1e-5, 0.3).restitution, 0.53942, 2e-3); // omega dt = 2.2e-3, order 1
}

TEST(MultibodyStops, BodyRestsOnADampedStopAtItsStaticOverlap) {
  // Static load by gravity: neither integrator may treat the damper's limit as a release.
  for (const SolverOptions& options : {rattle(), symplecticEuler()}) {
    Mechanism p = bouncingSlider(1e4, 250); // zeta 0.88
    p.state.pose[0].position.z = p.state.joint[0].position = -0.1;
    Solver solver(p.model, options);
    for (int i = 0; i < 2000; ++i) solver.step(p.state, p.loads, 1e-3);
    EXPECT_NEAR(p.state.joint[0].position, -0.1 - 2 * 9.81 / 1e4, 1e-12); // exp(-60 t) has decayed
    EXPECT_NEAR(p.state.joint[0].springForce, 2 * 9.81, 1e-8);
  }
}

TEST(MultibodyStops, WhatAStopTakesIsDissipatedToTheLastOfItsSpring) {
  // While the damper is at its limit it dissipates the spring's energy: the spring leaves no residual in the ledger.
  // Relative to 1 J; symplectic Euler's own error is 2 omega dt of that (measured 1.3), rattle's of round-off.
  for (const auto& [options, error] : {std::pair{rattle(), 1e-12}, {symplecticEuler(), 0.015}}) {
    Mechanism p = bouncingSlider(1e6, 1000);
    setTwist(p.model, p.state, 0, {{0, 0, -1}, {}});
    p.loads.gravity = {};
    p.state.pose[0].position.z = p.state.joint[0].position = -0.0999;
    beginLedger(p.model, p.state, p.loads);
    Solver solver(p.model, options);
    for (int i = 0; i < 2000; ++i) solver.step(p.state, p.loads, 1e-5);
    const Balance b = balance(p.model, p.state, p.loads);
    EXPECT_GT(b.stopDamping, 0.5);
    EXPECT_NEAR(b.elasticGain, 0, 1e-14);
    EXPECT_NEAR(b.stopDamping, -b.kineticGain, error);
  }
}

} // namespace
} // namespace grouser::multibody::test

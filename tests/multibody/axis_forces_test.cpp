// SPDX-License-Identifier: BSD-3-Clause
// Combined forces along one axis: several torques, and a stop with a damper that acts only on entry.
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::multibody::test {
namespace {

SolverOptions euler() {
  SolverOptions o;
  o.integrator = Integrator::kSymplecticEuler;
  return o;
}

TEST(AxisForces, TorquesOnOneAxisAddUpWithBothIntegrators) {
  for (const SolverOptions& options : {euler(), rattle()}) {
    Mechanism m;
    m.model.addBody(makeBody("wheel", 1, Mat3d::diagonal({0.25, 0.25, 0.4}), {}));
    m.model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
    for (const double torque : {2.0, 3.0}) {
      Drive d;
      d.name = torque == 2 ? "motor" : "other", d.kind = DriveKind::kForce, d.law = TimeLaw::constant(torque);
      m.model.addDrive(d);
    }
    m.start();
    run(m, options, 1e-3, 0.2);
    EXPECT_NEAR(m.state.joint[0].rate, 5 / 0.4 * 0.2, 1e-9);
  }
}

TEST(AxisForces, AStopIsDampedBothWaysUntilItWouldPull) {
  // 1 kg at 2 m/s into 1e4 N/m with a damping ratio of 0.3, i.e. 60 N s/m: on entry a damped oscillation to
  // v / omega exp(-zeta / r atan(r / zeta)), r = sqrt(1 - zeta^2); the return loses the same share of the speed, until
  // the release at k x + c x' = 0.
  const double v = 2, omega = 100, zeta = 0.3, r = std::sqrt(1 - zeta * zeta);
  const double deepest = v / omega * base::exp(-zeta / r * base::atan(r / zeta));
  for (const double side : {1.0, -1.0}) {
    Mechanism m;
    m.model.addBody(makeBody("sled", 1, Mat3d::diagonal({1, 1, 1}), {}, {side * v, 0, 0}));
    m.model.addJointAt("rail", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {1, 0, 0}));
    AxisSpring stops;
    stops.name = "stops", stops.joint = 0, stops.lowerLimit = -0.01, stops.upperLimit = 0.01;
    stops.stopStiffness = 1e4, stops.stopDamping = 60;
    m.model.addAxisSpring(stops);
    m.start();
    m.loads.gravity = {};
    Solver solver(m.model, euler());
    double most = 0;
    for (int i = 0; i < 4000; ++i) { // it leaves the stop after 34 ms
      solver.step(m.state, m.loads, 1e-5);
      most = std::max(most, side * m.state.joint[0].position);
    }
    // Order 1: omega dt = 1e-3.
    EXPECT_NEAR(most - 0.01, deepest, 3e-3 * deepest);
    EXPECT_NEAR(m.state.joint[0].rate, -side * omega * omega * deepest * deepest / v, 3e-3 * v) << "to the other stop";
    ASSERT_LT(std::fabs(m.state.joint[0].position), 0.01);
  }
}

} // namespace
} // namespace grouser::multibody::test

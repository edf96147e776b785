// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

namespace grouser::multibody::test {
namespace {

struct Cost {
  double microseconds = 1e9; ///< per step; best of five trials
  double solves = 0;         ///< solves of the slowest part, mean per step
};

Cost costOfAStep(Mechanism& m, int steps, double dt) {
  Solver solver(m.model);
  Cost cost;
  for (int trial = 0; trial < 5; ++trial) {
    int solves = 0;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps; ++i) {
      solver.step(m.state, m.loads, dt);
      solves += solver.lastStep().iterations;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    cost.microseconds = std::min(cost.microseconds, time.count() / steps * 1e6);
    cost.solves = static_cast<double>(solves) / steps;
  }
  return cost;
}

RingSpec shoeRing(int links) {
  RingSpec spec;
  spec.links = links, spec.pitch = 0.154, spec.mass = 8.5, spec.spin = 1, spec.damping = 5;
  spec.inertia = Mat3d::diagonal({0.09, 0.02, 0.10});
  return spec;
}

/// Two rings of 46 shoes and a chassis with 32 bodies: 10 arms with wheels, 6 rollers, 2 sprockets, 2 carriers with
/// idlers.
Mechanism vehicleSized() {
  Mechanism m;
  for (int side = 0; side < 2; ++side) {
    RingSpec spec = shoeRing(46);
    spec.centre = {0, side == 0 ? 1.0 : -1.0, 0};
    spec.name = side == 0 ? "left" : "right";
    addRing(m.model, spec);
  }
  const Mat3d I = Mat3d::diagonal({0.4, 0.7, 0.5});
  const int chassis = m.model.addBody(makeBody("chassis", 3700, Mat3d::diagonal({3000, 4000, 5000}), {}));
  for (int side = 0; side < 2; ++side) {
    const double y = side == 0 ? 1 : -1;
    const std::string s = side == 0 ? " left" : " right";
    const auto add = [&](const std::string& name, const Vec3d& p, int parent, JointType type, const Vec3d& axis,
                         double damping) {
      const int body = m.model.addBody(makeBody(name + s, 20, I, {p, {}}));
      m.model.addJointAt(name + " joint" + s, type, parent, body, frameWithZ(p, axis), damping);
      return body;
    };
    for (int i = 0; i < 5; ++i) {
      const std::string n = std::to_string(i);
      const int arm = add("arm " + n, {0.5 * i, y, -0.1}, chassis, JointType::kRevolute, kY, 0);
      m.model.addAxisSpring({"torsion " + n + s, m.model.jointIndex("arm " + n + " joint" + s), 7700, 300, 0, 0});
      add("wheel " + n, {0.5 * i - 0.2, y, -0.2}, arm, JointType::kRevolute, kY, 0.1);
    }
    for (int i = 0; i < 3; ++i)
      add("roller " + std::to_string(i), {0.7 * i, y, 0.2}, chassis, JointType::kRevolute, kY, 0.1);
    add("sprocket", {-0.5, y, 0}, chassis, JointType::kRevolute, kY, 0);
    m.model.addDrive({"motor" + s, m.model.jointIndex("sprocket joint" + s), 1, true});
    const int carrier = add("carrier", {2.5, y, 0}, chassis, JointType::kPrismatic, {1, 0, 0}, 0);
    m.model.addAxisSpring({"tensioner" + s, m.model.jointIndex("carrier joint" + s), 3e5, 4000, 0, 0});
    add("idler", {2.6, y, 0}, carrier, JointType::kRevolute, kY, 0.1);
  }
  m.start();
  return m;
}

TEST(MultibodySpeed, CostOfARingGrowsLinearlyWithItsLinks) {
  const auto ring = [](int links) {
    Mechanism m;
    addRing(m.model, shoeRing(links));
    m.start();
    return costOfAStep(m, 200, 5e-5);
  };
  const Cost c46 = ring(46), c92 = ring(92), c184 = ring(184);
  const double t46 = c46.microseconds, t92 = c92.microseconds, t184 = c184.microseconds;
  std::printf("ring step: %.1f us (46), %.1f us (92), %.1f us (184); ratios %.2f %.2f; solves %.2f %.2f %.2f\n", t46,
              t92, t184, t92 / t46, t184 / t92, c46.solves, c92.solves, c184.solves);
  // Linear growth yields 4, quadratic 16; the bound leaves room for busy machines.
  EXPECT_LT(t184 / t46, 10);
}

TEST(MultibodySpeed, VehicleSizedStep) {
  Mechanism m = vehicleSized();
  const Cost cost = costOfAStep(m, 400, 5e-5);
  std::printf("two rings of 46 and a chassis with %zu bodies: %.1f us a step, %.2f solves\n",
              m.model.bodies().size() - 93, cost.microseconds, cost.solves);
  EXPECT_LT(cost.microseconds, 2000); // the real-time budget is 60; detects only a loss by an order of magnitude
}

} // namespace
} // namespace grouser::multibody::test

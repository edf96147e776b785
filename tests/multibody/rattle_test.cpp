// SPDX-License-Identifier: BSD-3-Clause
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace grouser::multibody::test {
namespace {

SolverOptions rattle(int order = 2) {
  SolverOptions o;
  o.integrator = Integrator::kRattle;
  o.order = order;
  return o;
}

/// B1: point mass on a massless rod of 1 m, released at rest from the horizontal.
Mechanism pointPendulum() {
  Mechanism p;
  Body bob = makeBody("bob", 1, {}, {{1, 0, 0}, {}});
  bob.point = true;
  p.model.addBody(bob);
  p.model.addJoint({"rod", JointType::kDistance, kWorld, 0, {}, {}, 0});
  p.start();
  p.loads.gravity = {0, 0, -9.81};
  return p;
}

double pendulumError(int order, double dt, double t, const Vec3d& reference) {
  Mechanism p = pointPendulum();
  Solver solver(p.model, rattle(order));
  const int steps = static_cast<int>(t / dt + 0.5);
  for (int i = 0; i < steps; ++i) solver.step(p.state, p.loads, dt);
  return length(p.state.pose[0].position - reference);
}

TEST(Rattle, PendulumConvergesWithTheOrderOfTheScheme) {
  const Vec3d at10{.2750874625761169, 0, -.9614192050991251};
  for (const int order : {2, 4, 6, 8}) {
    const double h = order == 2 ? 2e-3 : order == 4 ? 2e-2 : 5e-2;
    const double a = pendulumError(order, h, 10, at10), b = pendulumError(order, h / 2, 10, at10);
    std::printf("pendulum, order %d: error at 10 s %.3e at %g s, %.3e at half, measured order %.2f\n", order, a, h, b,
                std::log2(a / b));
  }
}

} // namespace
} // namespace grouser::multibody::test

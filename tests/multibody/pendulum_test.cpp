// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace grouser::multibody {
namespace {

struct Pendulum {
  Model model;
  State state;
  Loads loads;
};

/// B1: 1 kg at the end of a massless rod of 1 m, released at rest from the horizontal; x right, z up, axis y.
/// The point is a body of inertia 1e-9 kg m2, which changes the period by 5e-10 of itself.
Pendulum pointPendulum() {
  Pendulum p;
  Body mass;
  mass.name = "mass";
  mass.inertia_B = Mat3d::diagonal({1e-9, 1e-9, 1e-9});
  mass.pose.position = {1, 0, 0};
  p.model.addBody(mass);
  p.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({0, 0, 0}, {0, 1, 0}));
  p.state = makeState(p.model);
  p.loads = makeLoads(p.model);
  return p;
}

double pendulumError(double dt) {
  Pendulum p = pointPendulum();
  Solver solver(p.model);
  const int steps = static_cast<int>(10 / dt + 0.5);
  for (int i = 0; i < steps; ++i) {
    solver.step(p.state, p.loads, dt);
    EXPECT_LE(solver.lastStep().maxPositionError, 1e-10);
  }
  // Exact at t = 10 s: theta = 2 asin(k sn(K - sqrt(g) t)), k = sin 45 degrees.
  const Vec3d& x = p.state.pose[0].position;
  return std::sqrt((x.x - .2750874625761169) * (x.x - .2750874625761169) +
                   (x.z + .9614192050991251) * (x.z + .9614192050991251));
}

TEST(MultibodyPendulum, FollowsTheExactSolutionWithOrderOne) {
  const double coarse = pendulumError(2e-3), middle = pendulumError(1e-3), fine = pendulumError(5e-4);
  std::printf("pendulum error at 10 s: %.3e %.3e %.3e, orders %.3f %.3f\n", coarse, middle, fine,
              std::log2(coarse / middle), std::log2(middle / fine));
  EXPECT_LT(fine, 2e-2);
  EXPECT_NEAR(std::log2(coarse / middle), 1, 0.1);
  EXPECT_NEAR(std::log2(middle / fine), 1, 0.1);
}

} // namespace
} // namespace grouser::multibody

// SPDX-License-Identifier: BSD-3-Clause
// End stops: what they give back, how exactly, and how that goes with the step.
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

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

/// A slider that falls on a stop below.
Mechanism bouncingSlider(double stiffness, double damping) {
  Mechanism p;
  p.model.addBody(makeBody("slider", 2, Mat3d::diagonal({0.1, 0.1, 0.1}), {{0, 0, 0}, {}}));
  p.model.addJointAt("rail", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {0, 0, 1}));
  AxisSpring stop;
  stop.name = "stop", stop.joint = 0, stop.lowerLimit = -0.1, stop.stopStiffness = stiffness, stop.stopDamping = damping;
  p.model.addAxisSpring(stop);
  p.start();
  return p;
}

/// A double pendulum whose upper rod meets a stop, so that the row turns and masses change.
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

TEST(MultibodyStops, Explore) {
  for (const double k : {1e4, 1e6})
    for (const double dt : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4}) {
      for (int which = 0; which < 2; ++which) {
        Mechanism p = which == 0 ? bouncingSlider(k, 0) : bouncingPendulum(k);
        Solver solver(p.model, rattle());
        const double start = energyOf(p);
        double worst = 0;
        int bounces = 0;
        double before = 0;
        long i = 0;
        for (; bounces < 1000 && i < 3000000; ++i) {
          solver.step(p.state, p.loads, dt);
          const double now = p.state.joint[0].springForce;
          if (now != 0 && before == 0) ++bounces;
          before = now;
          worst = std::max(worst, std::fabs(energyOf(p) - start));
        }
        std::printf("%s k %.0e dt %.0e omega dt %.3g: %d bounces %ld steps, energy %.3e worst %.3e J, left %.3e\n", which ? "pendulum" : "slider",
                    k, dt, dt * std::sqrt(k / 2), bounces, i, energyOf(p) - start, worst,
                    totals(p.model, p.state, p.loads).kinetic - p.state.ledger.gravityWork - p.state.ledger.springWork);
      }
    }
}

} // namespace
} // namespace grouser::multibody::test

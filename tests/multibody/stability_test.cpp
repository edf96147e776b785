// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace grouser::multibody::test {
namespace {

/// Two masses on one rail joined by a point spring; another spring ties the second to the rail's end.
Mechanism twoSprings(double k, double massRatio) {
  Mechanism m;
  const Mat3d I = Mat3d::diagonal({1, 1, 1});
  // Amplitudes of a few centimetres: the springs stay linear.
  m.model.addBody(makeBody("light", 1, I, {{1, 0, 0}, {}}, {0.03 * std::sqrt(k), 0, 0}));
  m.model.addBody(makeBody("heavy", massRatio, I, {{2, 0, 0}, {}}, {-0.02 * std::sqrt(k / massRatio), 0, 0}));
  m.model.addJointAt("rail 1", JointType::kPrismatic, kWorld, 0, frameWithZ({1, 0, 0}, {1, 0, 0}));
  m.model.addJointAt("rail 2", JointType::kPrismatic, kWorld, 1, frameWithZ({2, 0, 0}, {1, 0, 0}));
  PointSpring a, b;
  a.name = "to the world", a.bodyB = 0, a.stiffness = k, a.restLength = 1;
  b.name = "between", b.bodyA = 0, b.bodyB = 1, b.stiffness = k, b.restLength = 1;
  m.model.addPointSpring(a);
  m.model.addPointSpring(b);
  m.start();
  m.loads.gravity = {};
  return m;
}

/// Largest energy over 2000 steps, relative to the start.
double growth(Mechanism& m, Solver& solver, double dt) {
  const double start = energy(m);
  double most = 1;
  for (int i = 0; i < 2000 && most < 1e6; ++i) {
    solver.step(m.state, m.loads, dt);
    const double now = energy(m) / start;
    if (!(now <= most)) most = std::isfinite(now) ? now : 1e300;
  }
  return most;
}

TEST(Stability, ExplicitSpringsAreStableUpToTheStatedStepAndRefusedBeyond) {
  std::printf("stiffness  mass ratio  stated limit [s]  energy growth at 0.98 of it\n");
  for (const double k : {1e-1, 1e2, 1e5, 1e8})
    for (const double ratio : {1.0, 1e3, 1e6}) {
      Mechanism m = twoSprings(k, ratio);
      Solver solver(m.model, rattle());
      std::string name;
      const double limit = solver.stableStep(m.state, m.loads, &name);
      // Closed form: eigenvalues of [[2k, -k], [-k, k / ratio]].
      const double half = 0.5 * (2 + 1 / ratio), omega2 = k * (half + std::sqrt(half * half - 1 / ratio));
      EXPECT_NEAR(limit, 2 / std::sqrt(omega2), 1e-4 * limit);
      const double grown = growth(m, solver, 0.98 * limit);
      std::printf("%9.0e  %10.0e  %16.4e  %.2f\n", k, ratio, limit, grown);
      EXPECT_LT(grown, 60); // the modified energy's condition: 1 / (1 - 0.98^2) = 25, of two modes
      Mechanism beyond = twoSprings(k, ratio);
      Solver other(beyond.model, rattle());
      try {
        other.step(beyond.state, beyond.loads, 1.02 * limit);
        FAIL() << "not rejected";
      } catch (const base::InputError& e) {
        const std::string message = e.what();
        EXPECT_NE(message.find("spring '"), std::string::npos) << message;
        EXPECT_NE(message.find("implicit"), std::string::npos) << message;
      }
    }
}

/// Velocity of the lighter mass over its first, after various steps; only dampers act.
std::vector<double> braked(double damping, Integrator integrator, double dt, double* rate = nullptr) {
  Mechanism m = twoSprings(1e-9, 3);
  m.model = Model();
  m.model.addBody(makeBody("light", 1, Mat3d::diagonal({1, 1, 1}), {{1, 0, 0}, {}}, {3, 0, 0}));
  m.model.addBody(makeBody("heavy", 3, Mat3d::diagonal({1, 1, 1}), {{2, 0, 0}, {}}, {-1, 0, 0}));
  m.model.addJointAt("rail 1", JointType::kPrismatic, kWorld, 0, frameWithZ({1, 0, 0}, {1, 0, 0}));
  m.model.addJointAt("rail 2", JointType::kPrismatic, kWorld, 1, frameWithZ({2, 0, 0}, {1, 0, 0}));
  PointSpring damper;
  damper.name = "between", damper.bodyA = 0, damper.bodyB = 1, damper.damping = damping, damper.restLength = 1;
  m.model.addPointSpring(damper);
  m.start();
  m.loads.gravity = {};
  SolverOptions options;
  options.integrator = integrator, options.springs = Springs::kImplicit;
  Solver solver(m.model, options);
  std::string name;
  if (rate) *rate = solver.dampingRate(m.state, m.loads, &name);
  EXPECT_TRUE(!rate || name == "spring 'between'") << name;
  std::vector<double> velocities;
  for (int i = 0; i < 4; ++i) {
    solver.step(m.state, m.loads, dt);
    velocities.push_back(m.state.twist[0].v.x / 3);
  }
  return velocities;
}

/// Total momentum is zero, so that the reduced mass of 3/4 kg applies: rate 4/3 c. A rattle step scales velocities by
/// (2 - rate dt) / (2 + rate dt): beyond 2 / rate they reverse every step.
TEST(Stability, DampingRateIsThatOfTheReducedMassAndTwoOverItIsWhereRattleTurnsVelocitiesRound) {
  double rate = 0;
  braked(300, Integrator::kRattle, 1e-6, &rate);
  EXPECT_NEAR(rate, 400, 1e-4 * 400); // power iteration
  for (const double share : {0.5, 0.95, 1.05, 100.0}) {
    const std::vector<double> v = braked(300, Integrator::kRattle, share * 2 / rate);
    const double factor = (1 - share) / (1 + share);
    double expected = 1;
    for (const double now : v) EXPECT_NEAR(now, expected *= factor, 1e-3) << share; // the lever is its length at half
  }
  for (const double now : braked(300, Integrator::kSymplecticEuler, 1)) EXPECT_GE(now, -1e-9) << "at any step";
}

TEST(Stability, CompositionsAreStableUpToTheirOwnLimitsAndNotBeyond) {
  for (const int order : {2, 4, 6, 8}) {
    double most[2];
    for (int i = 0; i < 2; ++i) {
      Mechanism m = twoSprings(1e4, 1e3);
      Solver solver(m.model, rattle(order));
      const double limit = solver.stableStep(m.state, m.loads);
      // After the check: start with softer springs.
      for (auto& s : m.loads.pointSprings) s.stiffnessFactor = 0.8;
      solver.step(m.state, m.loads, (i == 0 ? 0.99 : 1.01) * limit);
      for (auto& s : m.loads.pointSprings) s.stiffnessFactor = 1;
      const double start = energy(m);
      most[i] = 0;
      for (int k = 0; k < 400 && most[i] < 1e3; ++k) {
        solver.step(m.state, m.loads, (i == 0 ? 0.99 : 1.01) * limit);
        most[i] = std::max(most[i], energy(m) / start);
      }
    }
    std::printf("order %d: energy grows to %.1f at 0.99, %.1e at 1.01 of the limit\n", order, most[0], most[1]);
    EXPECT_LT(most[0], 200);
    EXPECT_GT(most[1], 1e3);
  }
}

TEST(Stability, ExplicitSpringsAreUnstableJustBeyondTheStatedStep) {
  // A spring too soft at the start to limit the step, stiffened by its control: the check uses the loads that it
  // receives.
  Mechanism m = twoSprings(1e4, 1);
  Solver solver(m.model, rattle());
  const double limit = solver.stableStep(m.state, m.loads);
  for (auto& s : m.loads.pointSprings) s.stiffnessFactor = 0.9;
  solver.step(m.state, m.loads, 1.02 * limit); // stable at 0.9 of the stiffness; the check is only periodic
  for (auto& s : m.loads.pointSprings) s.stiffnessFactor = 1;
  const double start = energy(m);
  double most = 0;
  for (int i = 0; i < 400; ++i) {
    solver.step(m.state, m.loads, 1.02 * limit);
    most = std::max(most, energy(m) / start);
  }
  EXPECT_GT(most, 1e3);
}

TEST(Stability, ImplicitSpringsAreStableAtAnyStep) {
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle})
    for (const double k : {1e-1, 1e2, 1e5, 1e8, 1e11})
      for (const double ratio : {1.0, 1e3, 1e6})
        for (const double dt : {1e-6, 1e-3, 1.0}) {
          Mechanism m = twoSprings(k, ratio);
          SolverOptions o = rattle(2, Springs::kImplicit);
          o.integrator = integrator;
          Solver solver(m.model, o);
          // Midpoint conserves the energy of linear springs, except for round-off of k dt^2; Euler loses it.
          if (integrator == Integrator::kSymplecticEuler) solver.step(m.state, m.loads, dt);
          EXPECT_LT(growth(m, solver, dt), integrator == Integrator::kRattle ? 1 + 1e-6 + 1e-14 * k * dt * dt : 1.5)
              << "k " << k << " ratio " << ratio << " dt " << dt;
        }
}

TEST(Stability, StrongDampersAreRefusedWithOrdersThatGoBackInTime) {
  Mechanism m;
  m.model.addBody(makeBody("slider", 2, Mat3d::diagonal({1, 1, 1}), {}, {0, 0, 1}));
  m.model.addJoint({"rail", JointType::kPrismatic, kWorld, 0, {}, {}, 3.0});
  m.start();
  m.loads.gravity = {};
  for (const int order : {2, 4, 8}) {
    m.start();
    m.loads.gravity = {};
    run(m, rattle(order), 0.02, 1);
    // v = exp(-c t / m).
    EXPECT_NEAR(m.state.twist[0].v.z, std::exp(-1.5), order == 2 ? 1e-4 : order == 4 ? 1e-8 : 1e-12) << order;
    Solver solver(m.model, rattle(order));
    if (order == 2)
      EXPECT_NO_THROW(solver.step(m.state, m.loads, 1));
    else
      EXPECT_THROW(solver.step(m.state, m.loads, 1), base::InputError);
  }
}

TEST(Stability, DampersAndStopsNeverLimitTheStep) {
  for (const double c : {1.0, 1e3, 1e6, 1e9})
    for (const double k : {0.0, 1e4, 1e10}) {
      Mechanism m;
      m.model.addBody(makeBody("slider", 1, Mat3d::diagonal({1, 1, 1}), {}, {0, 0, 1}));
      m.model.addJoint({"rail", JointType::kPrismatic, kWorld, 0, {}, {}, c});
      AxisSpring stop;
      stop.name = "stop", stop.stopStiffness = 1e9, stop.upperLimit = 0.05, stop.lowerLimit = -0.05, stop.stiffness = k;
      m.model.addAxisSpring(stop);
      m.start();
      m.loads.gravity = {};
      Solver solver(m.model, rattle(2, Springs::kImplicit));
      const double start = energy(m);
      double reach = 0;
      for (int i = 0; i < 500; ++i) {
        solver.step(m.state, m.loads, 0.01);
        ASSERT_LT(energy(m), start * (1 + 1e-9)) << c << ' ' << k << ' ' << i;
        reach = std::max(reach, std::fabs(m.state.joint[0].position));
      }
      EXPECT_NEAR(energy(m) + m.state.ledger.dissipated, start, 1e-6 * start);
      EXPECT_LT(reach, 0.0501);
    }
}

TEST(Stability, ChainHoldsTipMassesUpToAMillionLinks) {
  // Static tension in the joint above link i: ((N - i) m + M) g.
  for (const double tip : {1.0, 1e3, 1e6}) {
    const int n = 46;
    Mechanism m;
    for (int i = 0; i < n; ++i)
      m.model.addBody(makeBody("link " + std::to_string(i), 1, Mat3d::diagonal({0.002, 0.002, 0.0002}),
                               {{0, 0, -0.15 * (i + 0.5)}, {}}));
    Body weight = makeBody("tip", tip, {}, {{0, 0, -0.15 * n}, {}});
    weight.point = true;
    m.model.addBody(weight);
    for (int i = 0; i < n; ++i)
      m.model.addJointAt("pin " + std::to_string(i), JointType::kRevolute, i - 1, i, frameWithZ({0, 0, -0.15 * i}, kY));
    m.model.addJointAt("hook", JointType::kSpherical, n - 1, n, {{0, 0, -0.15 * n}, {}});
    m.start();
    Solver solver(m.model, rattle());
    // A disturbance in the middle: lateral waves of a tip of 1e6 are fast; the joints must not open.
    m.loads.external[n / 2].force = {10, 0, 0};
    double gap = 0;
    for (int i = 0; i < 2000; ++i) {
      if (i == 100) m.loads.external[n / 2].force = {};
      solver.step(m.state, m.loads, tip > 1e4 ? 2e-5 : 1e-4);
      gap = std::max(gap, solver.lastStep().maxPositionError);
    }
    const double expected = (n + tip) * 9.81;
    std::printf("chain of %d, tip %.0e: tension at the top %.6e of %.6e N, gap %.1e m\n", n, tip,
                length(m.state.joint[0].force), expected, gap);
    EXPECT_LT(gap, 1e-13);
    EXPECT_NEAR(length(m.state.joint[0].force), expected, 2e-2 * expected); // it oscillates
  }
}

} // namespace
} // namespace grouser::multibody::test

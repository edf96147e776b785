// SPDX-License-Identifier: BSD-3-Clause
/// Singular positions: N four-bars in a row, all rods in line twice per turn, where the constraints lose rank and other
/// motions branch off. Steps may come at any distance from them.
#include "benchmarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace grouser::multibody::test {
namespace {

/// Like fourBars(), but in the x-y plane with all bodies' axes along the world's: rows are then along and across the
/// rods, and those along them lose their pivots altogether.
Mechanism alignedFourBars(int n) {
  Mechanism m;
  const double l = 1.0 / 12;
  for (int i = 0; i <= n; ++i)
    m.model.addBody(makeBody("upright " + std::to_string(i), 1, Mat3d::diagonal({l, 1e-4, l}), {{1.0 * i, 0.5, 0}, {}},
                             {0.5, 0, 0}, {0, 0, -1}));
  for (int i = 0; i < n; ++i)
    m.model.addBody(
        makeBody("coupler " + std::to_string(i), 1, Mat3d::diagonal({1e-4, l, l}), {{i + 0.5, 1, 0}, {}}, {1, 0, 0}));
  const auto pin = [&](const std::string& name, int a, int b, const Vec3d& p) {
    m.model.addJointAt(name, JointType::kRevolute, a, b, frameWithZ(p, {0, 0, 1}));
  };
  for (int i = 0; i <= n; ++i) pin("foot " + std::to_string(i), kWorld, i, {1.0 * i, 0, 0});
  for (int i = 0; i < n; ++i) {
    pin("left " + std::to_string(i), i, n + 1 + i, {1.0 * i, 1, 0});
    pin("right " + std::to_string(i), n + 1 + i, i + 1, {i + 1.0, 1, 0});
  }
  m.start();
  m.loads.gravity = {0, -9.81, 0};
  return m;
}

struct Passage {
  double error = 0, drift = 0; ///< error of the first upright's tip at the end [m]; largest energy drift [J]
};

Passage pass(int n, const SolverOptions& options, double dt, double t, const Vec3d& tip) {
  Mechanism m = alignedFourBars(n);
  Solver solver(m.model, options);
  const int steps = static_cast<int>(std::lround(t / dt));
  const double start = energy(m);
  Passage p;
  for (int i = 0; i < steps; ++i) {
    solver.step(m.state, m.loads, t / steps);
    p.drift = std::max(p.drift, std::fabs(energy(m) - start));
    EXPECT_LT(solver.lastStep().maxPositionError, 1e-9) << "t = " << m.state.time;
  }
  p.error = length(m.state.pose[0].toWorld({0, 0.5, 0}) - tip);
  std::printf("%d four-bars, dt %.3e s: error %.2e m (%.1f dt^2), energy off by %.2e J\n", n, dt, p.error,
              p.error / (dt * dt), p.drift);
  return p;
}

struct Case {
  int n;
  double t;
  Vec3d tip; ///< one degree of freedom in closed form: [(N+1)/3 + N] phi'' = g [(N+1)/2 + N] sin(phi)
  std::vector<double> steps;
};
const Case kCases[] = {
    {2, 10, {.328458111541, .944518538179, 0}, {1e-2, 6.25e-3, 3e-3, 1.56e-3, 7e-4, 3.9e-4, 1e-4}},
    {40, 5, {-.540190050676, -.841543052464, 0}, {1e-2, 6.25e-3, 3e-3, 1.56e-3}},
};

// Measured: 17 dt^2 for 2, 41 dt^2 for 40, at 1e-2 s 22 dt^2; the joints' tolerance of 1e-10 m leaves up to 1e-6 more.
// The energy of the nodes oscillates by dt times its rate, without drift.
TEST(SingularPosition, EulerPassesItAtAnyStep) {
  for (const Case& c : kCases)
    for (const double dt : c.steps) {
      const Passage p = pass(c.n, {}, dt, c.t, c.tip);
      EXPECT_LT(p.error, 50 * dt * dt + 1e-6) << c.n << " four-bars, dt = " << dt;
      EXPECT_LT(p.drift, 50 * (c.n + 1) * dt) << c.n << " four-bars, dt = " << dt;
    }
}

// Measured: 17 dt^2 for 2, 41 dt^2 for 40.
TEST(SingularPosition, RattlePassesItAtAnyStepWithItsOrder) {
  for (const Case& c : kCases)
    for (const double dt : c.steps) {
      const Passage p = pass(c.n, rattle(), dt, c.t, c.tip);
      EXPECT_LT(p.error, 50 * dt * dt) << c.n << " four-bars, dt = " << dt;
      EXPECT_LT(p.drift, 200 * (c.n + 1) * dt * dt) << c.n << " four-bars, dt = " << dt;
    }
}

// Measured: 2e-6 m and 5e-6 J at most; if no stage ends nearly in line, errors scale with dt^4.
TEST(SingularPosition, FourthOrderKeepsItsEnergyThroughIt) {
  for (const double dt : {1e-2, 6.25e-3, 3e-3, 1.56e-3, 7e-4}) {
    const Passage p = pass(2, rattle(4), dt, 10, kCases[0].tip);
    EXPECT_LT(p.error, 1e-5) << "dt = " << dt;
    EXPECT_LT(p.drift, 1e-5) << "dt = " << dt;
  }
}

// Factors kept between steps only save time: a resumed run computes new ones. A drive puts all rods in line
// at the ends of two steps: rows without a pivot there are missing in the kept matrix.
TEST(SingularPosition, ANewSolverInEveryStepGivesTheSameBits) {
  SolverOptions loose = rattle();
  loose.positionTolerance = 1e-9;
  for (const SolverOptions& options : {SolverOptions{}, rattle(), rattle(4), loose}) {
    Mechanism kept = alignedFourBars(2), anew = alignedFourBars(2);
    for (Mechanism* m : {&kept, &anew}) {
      m->model.addDrive({.name = "motor", .joint = 0, .speed = -1});
      m->start();
      m->loads.gravity = {};
    }
    Solver solver(kept.model, options);
    int singular = 0;
    constexpr int kQuarter = 50; // steps per quarter turn
    for (int i = 0; i < 4 * kQuarter; ++i) {
      const double dt = base::kPi / 2 / kQuarter;
      solver.step(kept.state, kept.loads, dt);
      Solver(anew.model, options).step(anew.state, anew.loads, dt);
      singular += solver.lastStep().singularRows > 0;
      ASSERT_EQ(kept.state.save(), anew.state.save()) << "step " << i;
    }
    EXPECT_GT(singular, 0);
  }
}

} // namespace
} // namespace grouser::multibody::test

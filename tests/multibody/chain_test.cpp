// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace grouser::multibody::test {
namespace {

// Exact results for chains and rings of links.

TEST(Chains, SpinningRingHoldsItsTension) {
  // T = m w^2 R cos(pi/N) / (2 sin(pi/N)); here of an M113's shoes at 10 rad/s.
  RingSpec spec;
  spec.links = 46, spec.pitch = .154, spec.mass = 18.02, spec.spin = 10;
  for (const RingJoints joints : {RingJoints::kAllRevolute, RingJoints::kOneSphericalOneUniversal}) {
    spec.joints = joints;
    Mechanism m;
    addRing(m.model, spec);
    m.start();
    m.loads.gravity = {};
    Solver solver(m.model, rattle());
    EXPECT_EQ(solver.degreesOfFreedom(), 46 - 3 + 6);
    EXPECT_EQ(solver.redundantRowNames().size(), joints == RingJoints::kAllRevolute ? 3u : 0u);
    double worst = 0, gap = 0;
    for (int i = 0; i < 500; ++i) {
      solver.step(m.state, m.loads, 1e-3);
      for (const JointReading& j : m.state.joint) worst = std::max(worst, std::fabs(length(j.force) - 14862.543522));
      gap = std::max(gap, solver.lastStep().maxPositionError);
    }
    std::printf("spinning ring, %s: tension off by %.1e N, gap %.1e m\n",
                joints == RingJoints::kAllRevolute ? "all revolute" : "not redundant", worst, gap);
    EXPECT_LT(worst, 1e-6 * 14862); // the printed digits, and round-off
    EXPECT_LT(gap, 1e-13);
  }
}

/// N links of length l hanging in the x-z plane, the ends of link i at p[i] and p[i + 1].
void addChain(Model& model, const std::vector<Vec3d>& p, double mass, bool endFixed) {
  const int n = static_cast<int>(p.size()) - 1;
  for (int i = 0; i < n; ++i) {
    const Vec3d &a = p[static_cast<std::size_t>(i)], &b = p[static_cast<std::size_t>(i) + 1];
    const double l = length(b - a), thin = mass * l * l / 12;
    model.addBody(makeBody("link " + std::to_string(i), mass, Mat3d::diagonal({0.01 * thin, thin, thin}),
                           {0.5 * (a + b), frameWithZX({}, cross(b - a, kY), b - a).orientation}));
  }
  for (int i = 0; i <= n; ++i) {
    if (i == n && !endFixed) break;
    model.addJointAt("pin " + std::to_string(i), i == n ? JointType::kSpherical : JointType::kRevolute,
                     i == n ? n - 1 : i - 1, i == n ? kWorld : i, frameWithZ(p[static_cast<std::size_t>(i)], kY));
  }
}

TEST(Chains, SmallSwingsHaveTheEigenfrequencies) {
  // Hanging chain, l = 0.15 m, uniform rods, N = 46 links of 10 kg: 1.43373813 rad/s (eigenvalues of the linear system;
  // continuum: j0/2 sqrt(g/L)). Released from a line at a small angle; measured by the zero crossings of the lowest
  // mode.
  for (const double tip : {0.0, 1e4}) {
    const int n = 46;
    std::vector<Vec3d> p;
    const double angle = 1e-4;
    for (int i = 0; i <= n; ++i) p.push_back({0.15 * i * base::sin(angle), 0, -0.15 * i * base::cos(angle)});
    Mechanism m;
    addChain(m.model, p, 10, false);
    if (tip > 0) {
      Body weight = makeBody("tip", tip, {}, {p.back(), {}});
      weight.point = true;
      m.model.addBody(weight);
      m.model.addJointAt("hook", JointType::kSpherical, n - 1, n, {p.back(), {}});
    }
    m.start();
    SolverOptions o = rattle();
    Solver solver(m.model, o);
    // Projection onto the lowest mode: with a heavy tip, the tip's motion; otherwise the mean of all links: it contains
    // all modes, but mainly the lowest.
    const double dt = 2e-3;
    std::vector<double> crossing;
    const auto swing = [&] {
      if (tip > 0) return m.state.pose[static_cast<std::size_t>(n)].position.x;
      double sum = 0;
      for (int i = 0; i < n; ++i) {
        // j0 of the continuum as the weight function.
        const double s = 2.404825557695773 * std::sqrt((n - i - 0.5) / n);
        double bessel = 0, term = 1;
        for (int k = 1; k < 30; ++k) bessel += term, term *= -0.25 * s * s / (k * k);
        sum += bessel * m.state.pose[static_cast<std::size_t>(i)].position.x;
      }
      return sum;
    };
    double before = swing();
    for (int i = 0; i < 4000; ++i) {
      solver.step(m.state, m.loads, dt);
      const double now = swing();
      if (before * now < 0) crossing.push_back(m.state.time - dt * now / (now - before));
      before = now;
    }
    ASSERT_GE(crossing.size(), 3u);
    const double omega = base::kPi * static_cast<double>(crossing.size() - 1) / (crossing.back() - crossing.front());
    const double expected = tip > 0 ? 1.19683379 : 1.43373813;
    std::printf("chain of 46, tip %.0e kg: lowest frequency %.6f rad/s, expected %.6f\n", tip, omega, expected);
    EXPECT_NEAR(omega, expected,
                (tip > 0 ? 2e-5 : 2e-3) * expected); // dt^2 terms; without a tip the weight is not the exact mode
  }
}

TEST(Chains, StrandBetweenRollersHangsInItsCatenary) {
  // 6 links of 0.1112 m over 2/3 m, held at both ends, placed in the discrete catenary of H = 6380 N:
  //   H tan(a_i) = (i - (n - 1) / 2) m g,   T about lambda g L^2 / (8 sag).
  const int n = 6;
  const double l = 0.1112, mass = 0.1112 * 1147.9 / 9.81;
  const double H = 6380;
  std::vector<Vec3d> p{{0, 0, 0}};
  for (int i = 0; i < n; ++i) {
    const double t = (i - 0.5 * (n - 1)) * mass * 9.81 / H, c = 1 / std::sqrt(1 + t * t);
    p.push_back(p.back() + Vec3d{l * c, 0, l * c * t});
  }
  Mechanism m;
  addChain(m.model, p, mass, true);
  m.start();
  Solver solver(m.model, rattle());
  const double span = p.back().x, sag = -p[n / 2].z;
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    solver.step(m.state, m.loads, 1e-3);
    for (int k = 1; k < n; ++k)
      worst = std::max(worst, std::fabs(std::fabs(m.state.joint[static_cast<std::size_t>(k)].force.x) - H));
  }
  std::printf("strand: sag %.2f mm, horizontal tension within %.1e N of %.0f N (parabola: %.0f N)\n", 1e3 * sag, worst,
              H, 1147.9 * span * span / (8 * sag));
  EXPECT_LT(worst, 1e-6 * H); // it stays at rest: the discrete catenary is its equilibrium
}

TEST(Chains, BeltOverTwoPulleysCarriesHalfTheIdlersForceAndTheTorque) {
  // A belt as a coupling of two pulleys, a spring pushes the idler's slide outwards: at rest the tension is T = F_s / 2
  // in either strand; a torque M on the driven pulley against a brake makes a difference of M / R between the strands.
  const double R = 0.25, F = 8000, M = 500;
  Mechanism m;
  const Mat3d I = Mat3d::diagonal({1, 1, 2});
  m.model.addBody(makeBody("sprocket", 20, I, {}));
  m.model.addBody(makeBody("slide", 5, Mat3d::diagonal({1, 1, 1}), {{2, 0, 0}, {}}));
  m.model.addBody(makeBody("idler", 20, I, {{2, 0, 0}, {}}));
  m.model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
  m.model.addJointAt("rail", JointType::kPrismatic, kWorld, 1, frameWithZ({2, 0, 0}, {1, 0, 0}));
  m.model.addJointAt("axle", JointType::kRevolute, 1, 2, {{2, 0, 0}, {}});
  Coupling belt;
  belt.name = "belt", belt.joint1 = 0, belt.joint2 = 2;
  m.model.addCoupling(belt);
  Drive motor, brake;
  motor.name = "motor", motor.joint = 0, motor.kind = DriveKind::kForce, motor.law = TimeLaw::constant(M);
  brake.name = "brake", brake.joint = 2, brake.kind = DriveKind::kForce, brake.law = TimeLaw::constant(-M);
  m.model.addDrive(motor), m.model.addDrive(brake);
  AxisSpring tensioner;
  tensioner.name = "tensioner", tensioner.joint = 1, tensioner.stiffness = 1e6, tensioner.preload = F;
  m.model.addAxisSpring(tensioner);
  // The belt supports the idler: a stiff rod along its strands.
  PointSpring strands;
  strands.name = "strands", strands.bodyB = 1, strands.stiffness = 1e8, strands.damping = 1e4, strands.restLength = 2;
  m.model.addPointSpring(strands);
  m.start();
  m.loads.gravity = {};
  run(m, rattle(2, Springs::kImplicit), 1e-3, 3);
  const double T = -m.state.spring[0].force, share = m.state.coupling[0].force / R;
  EXPECT_NEAR(T, F * 1e8 / (1e8 + 1e6), 1e-3); // both springs share the preload
  EXPECT_NEAR(share, M / R, 1e-9);             // T_tight - T_slack
  EXPECT_NEAR(m.state.twist[0].w.z, 0, 1e-12);
}

TEST(Chains, RodOnARevoluteAgreesWithTheReferenceToItsDigits) {
  // Rod of 4 m, centre of mass at 2 m, 1 kg, J = (0.04, 0.1, 0.1), g = 9.80665, from the horizontal (elliptic
  // functions; a commercial code prints the same six digits).
  Mechanism p;
  p.model.addBody(makeBody("rod", 1, Mat3d::diagonal({0.04, 0.1, 0.1}), {{2, 0, 0}, {}}));
  p.model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({0, 0, 0}, kY));
  p.start();
  p.loads.gravity = {0, 0, -9.80665};
  Solver solver(p.model, rattle(8));
  for (int i = 1; i <= 100; ++i) {
    solver.step(p.state, p.loads, 0.05);
    if (i != 20) continue;
    EXPECT_NEAR(p.state.pose[0].position.x, -.8923814855, 1e-8);
    EXPECT_NEAR(p.state.pose[0].position.z, -1.789875773, 1e-8);
  }
  EXPECT_NEAR(p.state.pose[0].position.x, -1.999683869, 1e-8);
}

} // namespace
} // namespace grouser::multibody::test

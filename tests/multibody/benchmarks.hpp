// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mechanisms.hpp"

#include <cmath>
#include <string>

/// Mechanisms with reference solutions (Library of Computational Benchmark Problems, IFToMM; Schiehlen 1990 for
/// Andrews' squeezing mechanism), and the error of a run.
namespace grouser::multibody::test {

inline SolverOptions rattle(int order = 2, Springs springs = Springs::kExplicit) {
  SolverOptions o;
  o.integrator = Integrator::kRattle;
  o.order = order;
  o.springs = springs;
  return o;
}

inline void run(Mechanism& m, const SolverOptions& options, double dt, double t) {
  Solver solver(m.model, options);
  const int steps = static_cast<int>(std::lround(t / dt));
  for (int i = 0; i < steps; ++i) solver.step(m.state, m.loads, dt);
}

inline double energy(const Mechanism& m) {
  const Totals t = totals(m.model, m.state, m.loads);
  return t.kinetic + t.gravity + t.elastic;
}

/// Point mass of 1 kg on a massless rod of 1 m, released at rest from the horizontal.
inline Mechanism pendulumOnARod() {
  Mechanism p;
  Body bob = makeBody("bob", 1, {}, {{1, 0, 0}, {}});
  bob.point = true;
  p.model.addBody(bob);
  p.model.addJoint({"rod", JointType::kDistance, kWorld, 0, {}, {}});
  p.start();
  return p;
}

/// Uniform rod of 1 m and 1 kg between two points of the x-z plane; its x axis points from one to the other.
inline int addRod(Model& model, const std::string& name, const Vec3d& from, const Vec3d& to, const Vec3d& v = {},
                  const Vec3d& w = {}) {
  const double l = length(to - from);
  const Mat3d I = Mat3d::diagonal({1e-3, l * l / 12, l * l / 12});
  const Vec3d x = (to - from) * (1 / l);
  return model.addBody(makeBody(name, 1, I, {0.5 * (from + to), frameWithZX({}, cross(x, kY), x).orientation}, v, w));
}

/// N-four-bar (IFToMM A02): N + 1 uprights and N couplers, all rods uniform, 1 m, 1 kg, started upright with B0 moving
/// at 1 m/s. Passes a position with all rods in line twice per turn.
inline Mechanism fourBars(int n) {
  Mechanism m;
  const Vec3d v{1, 0, 0}, w{0, 1, 0};
  for (int i = 0; i <= n; ++i) {
    const Vec3d foot{static_cast<double>(i), 0, 0}, top = foot + Vec3d{0, 0, 1};
    addRod(m.model, "upright " + std::to_string(i), foot, top, 0.5 * v, w);
  }
  for (int i = 0; i < n; ++i) {
    const Vec3d a{static_cast<double>(i), 0, 1}, b{i + 1.0, 0, 1};
    addRod(m.model, "coupler " + std::to_string(i), a, b, v);
  }
  const auto pin = [&](const std::string& name, int a, int b, const Vec3d& p) {
    m.model.addJointAt(name + " " + std::to_string(b), JointType::kRevolute, a, b, frameWithZ(p, kY));
  };
  for (int i = 0; i <= n; ++i) pin("foot", kWorld, i, {static_cast<double>(i), 0, 0});
  for (int i = 0; i < n; ++i) {
    pin("left", i, n + 1 + i, {static_cast<double>(i), 0, 1});
    pin("right", i + 1, n + 1 + i, {i + 1.0, 0, 1});
  }
  m.start();
  return m;
}

/// Tip of the first upright.
inline Vec3d tipOf(const Mechanism& m) { return 2.0 * m.state.pose[0].position; }

/// Andrews' squeezing mechanism (constants as in the test set for initial value problems, Mazzia and Magherini 2008,
/// and in Hairer and Wanner 1996, VII.7), in the x-y plane, seven bodies in three loops, closed in the reference
/// position q0. A constant torque of 0.033 N m on K1; a stiff spring on K3.
struct Andrews {
  // NOLINTBEGIN(readability-identifier-naming): the names of the test set
  static constexpr double m[8] = {0, .04325, .00365, .02373, .00706, .07050, .00706, .05498};
  static constexpr double I[8] = {0, 2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5};
  static constexpr double q0[7] = {
      -.0617138900142764496, 0, .455279819163070380, .222668390165885885, .487364979543842550, -.222668390165885885,
      1.23054744454982119};
  static constexpr double torque = .033;
  // NOLINTEND(readability-identifier-naming)

  static Mechanism make() {
    const double d = .028, da = .0115, e = .02, ea = .01421, rr = .007, ra = 9.2e-4, sa = .01874, sb = .01043,
                 sc = .018, sd = .02, ta = .02308, tb = .00916, u = .04, ua = .01228, ub = .00449, zf = .02, zt = .04,
                 fa = .01421, l0 = .07785, c0 = 4530;
    const Vec3d O{}, A{-.06934, -.00227, 0}, B{-.03635, .03273, 0}, C{.014, .072, 0};
    const double angle[8] = {0, q0[0], q0[0] + q0[1], q0[2], q0[3] + q0[4], q0[4], q0[5] + q0[6], q0[6]};
    const auto turned = [](double a, double x, double y) {
      const double c = base::cos(a), s = base::sin(a);
      return Vec3d{c * x - s * y, s * x + c * y, 0};
    };
    const Vec3d F = O + turned(angle[1], rr, 0), E = F + turned(angle[2], -d, 0), G = A + turned(angle[5], zt, 0),
                H = A + turned(angle[7], 0, -u);
    const Vec3d centre[8] = {{},
                             O + turned(angle[1], ra, 0),
                             F + turned(angle[2], -da, 0),
                             B + turned(angle[3], sa, -sb),
                             G + turned(angle[4], 0, -(e - ea)),
                             A + turned(angle[5], ta, tb),
                             H + turned(angle[6], zf - fa, 0),
                             A + turned(angle[7], ua, -ub)};
    Mechanism s;
    for (int k = 1; k < 8; ++k)
      s.model.addBody(makeBody("K" + std::to_string(k), m[k], Mat3d::diagonal({I[k], I[k], I[k]}),
                               {centre[k], {base::cos(angle[k] / 2), 0, 0, base::sin(angle[k] / 2)}}));
    const auto pin = [&](const std::string& name, int a, int b, const Vec3d& p) {
      const Vec3d inA = a == kWorld ? p : s.model.bodies()[static_cast<std::size_t>(a)].pose.toBody(p);
      s.model.addJoint({name, JointType::kRevolute, a, b, {inA, {}}, {inB(s.model, b, p), {}}});
    };
    pin("O", kWorld, 0, O), pin("F", 0, 1, F), pin("B", kWorld, 2, B), pin("A5", kWorld, 4, A), pin("A7", kWorld, 6, A);
    pin("G", 4, 3, G), pin("H", 6, 5, H), pin("E3", 1, 2, E), pin("E4", 1, 3, E), pin("E6", 1, 5, E);
    Drive motor;
    motor.name = "motor", motor.joint = 0, motor.kind = DriveKind::kForce, motor.law = TimeLaw::constant(torque);
    s.model.addDrive(motor);
    const Vec3d D = B + turned(angle[3], sd, -sc);
    PointSpring spring;
    spring.name = "spring", spring.bodyA = kWorld, spring.bodyB = 2, spring.point_A = C;
    spring.point_B = inB(s.model, 2, D), spring.stiffness = c0, spring.restLength = l0;
    s.model.addPointSpring(spring);
    s.start();
    s.loads.gravity = {};
    return s;
  }

  static Vec3d inB(const Model& model, int b, const Vec3d& p) {
    return model.bodies()[static_cast<std::size_t>(b)].pose.toBody(p);
  }
  /// Angle beta of the crank [rad].
  static double beta(const Mechanism& s) { return s.state.joint[0].position; }
};

/// Free asymmetric top, I = (1, 2, 3) kg m2.
inline Mechanism freeTop(const Vec3d& w) {
  Mechanism t;
  t.model.addBody(makeBody("top", 1, Mat3d::diagonal({1, 2, 3}), {}, {}, w));
  t.start();
  t.loads.gravity = {};
  return t;
}

/// Angle between two attitudes [rad].
inline double attitudeError(const Quat& a, const Quat& b) {
  const Quat d = a * b.conjugate();
  return 2 * std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

} // namespace grouser::multibody::test

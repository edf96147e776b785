// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

/// The books (multibody/ledger.hpp). What is left over is rounding: 1e-9 of the turnover bounds it with room, since
/// 1e4 steps round by some 1e-16 sqrt(1e4) of it.
namespace grouser::multibody::test {
namespace {

constexpr double kRounding = 1e-9;

double last(double x) { return std::fabs(x); }
double last(const Vec3d& v) { return length(v); }

/// Two rods of 1 m, hanging from a pin, let go from the horizontal.
Mechanism doublePendulum() {
  Mechanism m;
  addRod(m.model, "upper", {}, {1, 0, 0});
  addRod(m.model, "lower", {1, 0, 0}, {2, 0, 0});
  m.model.addJointAt("shoulder", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  m.model.addJointAt("elbow", JointType::kRevolute, 0, 1, frameWithZ({1, 0, 0}, kY));
  m.start();
  return m;
}

/// A bob on a spring from a point of the world, let go stretched and aside, with a speed out of the plane.
Mechanism springPendulum(double damping = 0) {
  Mechanism m;
  m.model.addBody(makeBody("bob", 1, Mat3d::diagonal({0.1, 0.1, 0.1}), {{0.8, 0, -0.9}, {}}, {0, 0.5, 0}));
  PointSpring spring;
  spring.name = "spring", spring.bodyB = 0, spring.stiffness = 200, spring.restLength = 1, spring.damping = damping;
  spring.preload = 3;
  m.model.addPointSpring(spring);
  m.start();
  return m;
}

/// A top of 1 kg whose centre is 0.3 m from its tip, leaning by 0.4 rad, at 20 rad/s.
Mechanism heavyTop() {
  Mechanism m;
  const Quat lean = aboutY(0.4);
  const Vec3d axis = lean.matrix() * Vec3d{0, 0, 1}, w = 20.0 * axis;
  m.model.addBody(makeBody("top", 1, Mat3d::diagonal({0.02, 0.02, 0.03}), {0.3 * axis, lean}, {}, w));
  m.model.addJointAt("tip", JointType::kSpherical, kWorld, 0, {});
  m.start();
  return m;
}

Mechanism shoes() {
  Mechanism m;
  RingSpec ring;
  ring.links = 12, ring.spin = 3, ring.joints = RingJoints::kOneSphericalOneUniversal;
  addRing(m.model, ring);
  // Hangs by a spring and is pushed out of round.
  m.model.addPointSpring({"rope", kWorld, 0, {0, 0, 1}, {}, 500, 0, 0.6, 0});
  m.start();
  m.loads.external[3].force = {4, 2, 1}, m.loads.external[5].torque = {0.1, 0.2, 0.05};
  return m;
}

/// A crank on a slide with a gear, all that impulses go through: coupling, drive, stops, bushing, fixed body.
Mechanism oddments() {
  Mechanism m;
  Body bed = makeBody("bed", 1, Mat3d::identity(), {{0, 0, -1}, {}});
  bed.fixed = true;
  m.model.addBody(bed);
  const Mat3d I = Mat3d::diagonal({0.02, 0.03, 0.04});
  m.model.addBody(makeBody("wheel", 2, I, {{0.1, 0, 0}, {}}));
  m.model.addBody(makeBody("pinion", 1, I, {{0.5, 0, 0.05}, {}}));
  m.model.addBody(makeBody("block", 1.5, I, {{0, 0.3, -0.8}, {}}, {0.2, 0.1, -0.3}, {0.3, -0.2, 0.5}));
  m.model.addJointAt("axle", JointType::kRevolute, 0, 1, frameWithZ({}, kY), 0.02);
  m.model.addJointAt("shaft", JointType::kRevolute, kWorld, 2, frameWithZ({0.5, 0, 0}, kY));
  m.model.addJointAt("rail", JointType::kCylindrical, 3, 0, frameWithZ({0, 0.3, -0.5}, {0, 0.1, 1}), 0);
  Coupling gear;
  gear.name = "gear", gear.joint1 = 0, gear.joint2 = 1, gear.ratio = -2;
  m.model.addCoupling(gear);
  AxisSpring slide;
  slide.name = "slide", slide.joint = 2, slide.axis = JointAxis::kSlide, slide.stiffness = 40, slide.damping = 1;
  slide.lowerLimit = -0.05, slide.upperLimit = 0.05, slide.stopStiffness = 2e3, slide.stopDamping = 5;
  m.model.addAxisSpring(slide);
  Drive motor;
  motor.name = "motor", motor.joint = 1, motor.kind = DriveKind::kForce, motor.law.harmonics = {{1.5, 7, 0.3}};
  m.model.addDrive(motor);
  m.start();
  setTwist(m.model, m.state, 3, {});
  m.loads.external[3].force = {0.3, 0.2, 1}, m.loads.external[1].torque = {0, 0.4, 0.1};
  return m;
}

struct Case {
  std::string name;
  std::function<Mechanism()> make;
  double step, duration; ///< [s]
  double coarse;         ///< a step at which the motion is ill resolved [s]
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"pendulum", pendulumOnARod, 1e-3, 10, 0.1},       {"double pendulum", doublePendulum, 1e-3, 10, 0.05},
      {"spring pendulum", [] { return springPendulum(); }, 1e-3, 10, 0.05}, {"heavy top", heavyTop, 1e-3, 10, 0.01},
      {"four bar", [] { return fourBars(1); }, 1e-3, 10, 0.02}, {"ring", shoes, 1e-3, 2.5, 0.02},
      {"oddments", oddments, 1e-3, 5, 0.01}};
  return all;
}

struct Scheme {
  std::string name;
  SolverOptions options;
  double order;
};
std::vector<Scheme> schemes() {
  return {{"euler", {}, 1},
          {"rattle2", rattle(), 2},
          {"rattle2 implicit", rattle(2, Springs::kImplicit), 2},
          {"rattle4", rattle(4), 4}};
}

TEST(MultibodyLedger, Print) {
  for (const Case& c : cases())
    for (const Scheme& s : schemes()) {
      double before = 0;
      for (const double step : {c.coarse, c.step, c.step / 2, c.step / 4}) {
        Mechanism m = c.make();
        SolverOptions o = s.options;
        o.startVelocities = StartVelocities::kAccept;
        try {
        Solver solver(m.model, o);
        const auto steps = std::lround(c.duration / step);
        double worst = 0;
        for (long i = 0; i < steps; ++i) {
          solver.step(m.state, m.loads, step);
          const double e = m.state.ledger.integrationError();
          worst = std::max(worst, std::fabs(e));
        }
        const Balance b = balance(m.model, m.state, m.loads);
        const Totals t = totals(m.model, m.state, m.loads);
        std::printf("%-16s %-16s h %-8.3g left %.1e (%.1e of %.3g)  lin %.1e ang %.1e error %.2e max %.2e order %.2f diss %.3g %.3g %.3g P %.2g L %.2g\n", c.name.c_str(),
                    s.name.c_str(), step, b.leftOver, std::fabs(b.leftOver) / b.turnover, b.turnover,
                    last(b.linearLeftOver), last(b.angularLeftOver), b.integrationError, worst,
                    before > 0 ? std::log2(before / worst) : 0, b.jointDamping, b.springDamping, b.stopDamping, length(t.linearMomentum), length(t.angularMomentum));
        before = worst;
        } catch (const std::exception& e) { std::printf("%s %s: %s\n", c.name.c_str(), s.name.c_str(), e.what()); }
      }
    }
}

} // namespace
} // namespace grouser::multibody::test

// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

/// Energy ledger (multibody/ledger.hpp). The residual is rounding: 1e-9 of the turnover is a safe bound, since
/// 1e4 steps round by some 1e-16 sqrt(1e4) of it.
namespace grouser::multibody::test {
namespace {

constexpr double kRounding = 1e-9;

/// Two rods of 1 m hang from a pin, released from the horizontal.
Mechanism doublePendulum() {
  Mechanism m;
  addRod(m.model, "upper", {}, {1, 0, 0});
  addRod(m.model, "lower", {1, 0, 0}, {2, 0, 0});
  m.model.addJointAt("shoulder", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  m.model.addJointAt("elbow", JointType::kRevolute, 0, 1, frameWithZ({1, 0, 0}, kY));
  m.start();
  return m;
}

/// A bob on a spring from a fixed point, released stretched and off-axis, with a speed out of the plane.
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

/// A top of 1 kg with its centre 0.3 m from its tip, inclined by 0.4 rad, at 20 rad/s.
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
  // Hangs by a spring and is pushed off centre.
  m.model.addPointSpring({"rope", kWorld, 0, {0, 0, 1}, {}, 500, 0, 0.6, 0});
  m.start();
  m.loads.external[3].force = {4, 2, 1}, m.loads.external[5].torque = {0.1, 0.2, 0.05};
  return m;
}

/// A crank on a slide with a gear, with all impulse paths: coupling, drive, stops, bushing, fixed body.
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
  double coarse;         ///< a step too long to resolve the motion [s]
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all{{"pendulum", pendulumOnARod, 1e-3, 10, 0.1},
                                     {"double pendulum", doublePendulum, 1e-3, 10, 0.05},
                                     {"spring pendulum", [] { return springPendulum(); }, 1e-3, 10, 0.05},
                                     {"heavy top", heavyTop, 1e-3, 10, 0.01},
                                     {"four bar", [] { return fourBars(1); }, 1e-3, 10, 0.02},
                                     {"ring", shoes, 5e-4, 5, 0.01},
                                     {"oddments", oddments, 5e-4, 5, 0.01}};
  return all;
}

SolverOptions accepting(SolverOptions options) {
  options.startVelocities = StartVelocities::kAccept;
  return options;
}

/// Sums of |momentum| over the bodies, about the world's origin: reference for rounding of the sums.
struct Scale {
  double linear = 0, angular = 0;
};
void widen(Scale& scale, const Mechanism& m) {
  Scale now;
  for (std::size_t b = 0; b < m.state.pose.size(); ++b) {
    if (m.model.bodies()[b].fixed) continue;
    const double p = m.model.bodies()[b].mass * length(m.state.twist[b].v);
    now.linear += p, now.angular += p * length(m.state.pose[b].position) + length(m.state.angularMomentum[b]);
  }
  scale.linear = std::max(scale.linear, now.linear), scale.angular = std::max(scale.angular, now.angular);
}

void expectClosedBooks(const Case& c, const SolverOptions& options, double step) {
  Mechanism m = c.make();
  Solver solver(m.model, accepting(options));
  const auto steps = std::lround(c.duration / step);
  const Totals start = totals(m.model, m.state, m.loads);
  Scale scale;
  for (long i = 0; i < steps; ++i) {
    solver.step(m.state, m.loads, step);
    if (i % 16 == 0) widen(scale, m);
  }
  const Balance b = balance(m.model, m.state, m.loads);
  EXPECT_GT(b.turnover, 1) << "the bodies have moved";
  EXPECT_LE(std::fabs(b.leftOver), kRounding * b.turnover);
  EXPECT_NEAR(b.kineticGain + b.potentialGain + b.elasticGain + b.dissipated() + b.integrationError,
              b.driveWork + b.externalWork, kRounding * b.turnover);
  const Totals end = totals(m.model, m.state, m.loads);
  EXPECT_NEAR(b.potentialGain, end.gravity - start.gravity, kRounding * b.turnover);
  EXPECT_NEAR(b.elasticGain, end.elastic - start.elastic, kRounding * b.turnover);
  EXPECT_LE(length(b.linearRemainder), kRounding * scale.linear);
  EXPECT_LE(length(b.angularRemainder), kRounding * scale.angular);
  if (c.name == "oddments") {
    EXPECT_GT(b.jointDamping, 0);
    EXPECT_GT(b.springDamping, 0);
    EXPECT_GT(b.stopDamping, 0);
    EXPECT_NE(b.driveWork, 0);
    EXPECT_NE(b.externalWork, 0);
  } else {
    EXPECT_EQ(b.jointDamping, 0);
    EXPECT_EQ(b.springDamping, 0);
    EXPECT_EQ(b.stopDamping, 0);
  }
}

/// 1e4 or more steps, except for the coarse ones, where the motion is unresolved and the ledger must still close.
void expectClosedBooksAtEveryStep(const SolverOptions& options) {
  for (const Case& c : cases())
    for (const double step : {c.coarse, c.step, c.step / 2, c.step / 4}) {
      SCOPED_TRACE(c.name + " at " + std::to_string(step) + " s");
      expectClosedBooks(c, options, step);
    }
}
TEST(MultibodyLedger, EulerLeavesOverWhatRoundsAtEveryStep) { expectClosedBooksAtEveryStep({}); }
TEST(MultibodyLedger, RattleLeavesOverWhatRoundsAtEveryStep) { expectClosedBooksAtEveryStep(rattle()); }
TEST(MultibodyLedger, ImplicitSpringsLeaveOverWhatRoundsAtEveryStep) {
  for (const Case& c : {cases()[2], cases()[6]})
    for (const double step : {c.coarse, c.step, c.step / 4}) {
      SCOPED_TRACE(c.name + " at " + std::to_string(step) + " s");
      expectClosedBooks(c, rattle(2, Springs::kImplicit), step);
    }
}
TEST(MultibodyLedger, BackwardStagesLeaveOverWhatRounds) {
  for (const Case& c : cases())
    for (const int order : {4, 8}) {
      SCOPED_TRACE(c.name + ", order " + std::to_string(order));
      expectClosedBooks(c, rattle(order), order == 4 ? c.step : 4 * c.step);
    }
}

/// Largest integration error of a run so far [J].
double worstError(Mechanism m, const SolverOptions& options, double step, double duration) {
  Solver solver(m.model, accepting(options));
  double worst = 0;
  for (long i = 0; i < std::lround(duration / step); ++i) {
    solver.step(m.state, m.loads, step);
    worst = std::max(worst, std::fabs(m.state.ledger.integrationError()));
  }
  return worst;
}

// Durations in which the motions are smooth and do not yet diverge.
TEST(MultibodyLedger, IntegrationErrorFallsWithTheOrder) {
  struct Smooth {
    std::string name;
    std::function<Mechanism()> make;
    double step, duration;
  };
  const std::vector<Smooth> all{{"pendulum", pendulumOnARod, 8e-3, 3},
                                {"double pendulum", doublePendulum, 4e-3, 1},
                                {"spring pendulum", [] { return springPendulum(); }, 2e-3, 0.5},
                                {"heavy top", heavyTop, 2e-3, 2},
                                {"four bar", [] { return fourBars(1); }, 4e-3, 0.5},
                                {"ring", shoes, 2e-3, 0.25}};
  struct Scheme {
    std::string name;
    SolverOptions options;
    double order, within;
  };
  const std::vector<Scheme> schemes{{"euler", {}, 1, 0.1},
                                    {"rattle", rattle(), 2, 0.1},
                                    {"rattle, implicit", rattle(2, Springs::kImplicit), 2, 0.1},
                                    {"rattle, order 4", rattle(4), 4, 0.2}};
  for (const Smooth& c : all)
    for (const Scheme& s : schemes) {
      // Numerical damping of Euler's implicit spring is considerable at these steps.
      const double step = s.order == 1 ? c.step / 16 : c.step;
      const double coarse = worstError(c.make(), s.options, step, c.duration);
      const double fine = worstError(c.make(), s.options, step / 2, c.duration);
      const double order = std::log2(coarse / fine);
      std::printf("%-16s %-17s error %.2e J, order %.2f\n", c.name.c_str(), s.name.c_str(), fine, order);
      EXPECT_NEAR(order, s.order, s.within) << c.name << ", " << s.name;
    }
}

/// A carrier of 2 kg on a slide without gravity.
Mechanism carrier(double speed, double position) {
  Mechanism m;
  m.model.addBody(makeBody("carrier", 2, Mat3d::identity(), {{position, 0, 0}, {}}, {speed, 0, 0}));
  const Vec3d x{1, 0, 0};
  m.model.addJoint({"slide", JointType::kPrismatic, kWorld, 0, frameWithZ({}, x), frameWithZ({}, x), 0.7});
  return m;
}

// A damped oscillator, released at x0: x = x0 e^(-d t) (cos w t + d / w sin w t), loss = energy then - energy now.
TEST(MultibodyLedger, DissipatedIsTheTrueLossOfADampedOscillatorByCause) {
  constexpr double kMass = 2, kStiffness = 50, kJoint = 0.7, kSpring = 1.4, kStart = 0.3, kTime = 1.7;
  const double d = (kJoint + kSpring) / (2 * kMass), w = std::sqrt(kStiffness / kMass - d * d);
  const double decay = kStart * std::exp(-d * kTime);
  const double x = decay * (std::cos(w * kTime) + d / w * std::sin(w * kTime));
  const double v = -decay * (w + d * d / w) * std::sin(w * kTime);
  const double loss = 0.5 * kStiffness * (kStart * kStart - x * x) - 0.5 * kMass * v * v;
  const auto run = [&](const SolverOptions& options, double step) {
    Mechanism m = carrier(0, kStart);
    AxisSpring spring;
    spring.name = "spring", spring.joint = 0, spring.stiffness = kStiffness, spring.damping = kSpring;
    m.model.addAxisSpring(spring);
    m.start();
    m.loads.gravity = {};
    Solver solver(m.model, options);
    for (long i = 0; i < std::lround(kTime / step); ++i) solver.step(m.state, m.loads, step);
    return balance(m.model, m.state, m.loads);
  };
  for (const auto& [options, order] :
       {std::pair{SolverOptions{}, 1.0}, std::pair{rattle(), 2.0}, std::pair{rattle(2, Springs::kImplicit), 2.0}}) {
    const Balance coarse = run(options, 1e-3), fine = run(options, 5e-4);
    const double error = std::fabs(fine.dissipated() - loss);
    const double measured = std::log2(std::fabs(coarse.dissipated() - loss) / error);
    std::printf("loss %.6f J, error %.2e J, order %.2f\n", loss, error, measured);
    EXPECT_LT(error, order == 1 ? 0.02 * loss : 2e-5 * loss);
    EXPECT_NEAR(measured, order, 0.1);
    EXPECT_NEAR(fine.springDamping, kSpring / kJoint * fine.jointDamping, 1e-12);
    EXPECT_EQ(fine.stopDamping, 0);
  }
}

// Along a slide RATTLE's stops conserve energy except for their dampers: their loss equals the kinetic energy lost.
TEST(MultibodyLedger, ADampedStopTakesWhatTheCarrierLoses) {
  Mechanism m;
  m.model.addBody(makeBody("carrier", 2, Mat3d::identity(), {}, {3, 0, 0}));
  m.model.addJointAt("slide", JointType::kPrismatic, kWorld, 0, frameWithZ({}, {1, 0, 0}));
  AxisSpring stop;
  stop.name = "stop", stop.joint = 0, stop.upperLimit = 0.1, stop.stopStiffness = 5e3, stop.stopDamping = 30;
  m.model.addAxisSpring(stop);
  for (const SolverOptions& options : {SolverOptions{}, rattle()}) {
    m.start();
    m.loads.gravity = {};
    Solver solver(m.model, options);
    while (m.state.time < 0.2) solver.step(m.state, m.loads, 1e-3);
    const Balance b = balance(m.model, m.state, m.loads);
    EXPECT_LT(m.state.twist[0].v.x, -0.5) << "it has returned";
    EXPECT_GT(b.stopDamping, 0.5);
    EXPECT_EQ(b.jointDamping, 0);
    EXPECT_EQ(b.springDamping, 0);
    EXPECT_NEAR(b.stopDamping + b.integrationError, -b.kineticGain, 1e-12);
    if (options.integrator == Integrator::kRattle) {
      EXPECT_NEAR(b.integrationError, 0, 1e-12);
    }
  }
}

TEST(MultibodyLedger, AConstantTorqueWorksTorqueTimesAngle) {
  constexpr double kTorque = 3, kStep = 0.01;
  for (const SolverOptions& options : {SolverOptions{}, rattle(), rattle(4)}) {
    Mechanism m;
    m.model.addBody(makeBody("rotor", 5, Mat3d::diagonal({0.4, 0.7, 0.4}), {}, {}, {0, 2, 0}));
    m.model.addJointAt("axle", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
    Drive motor;
    motor.name = "motor", motor.joint = 0, motor.kind = DriveKind::kForce, motor.law = TimeLaw::constant(kTorque);
    m.model.addDrive(motor);
    m.start();
    Solver solver(m.model, options);
    for (int i = 0; i < 1000; ++i) solver.step(m.state, m.loads, kStep);
    const Balance b = balance(m.model, m.state, m.loads);
    // Euler's angle advances by a full step at the end speed: half a step's gain of speed per step ahead.
    const double ahead = options.integrator == Integrator::kRattle ? 0 : 0.5 * kStep * (m.state.joint[0].rate - 2);
    EXPECT_NEAR(b.driveWork, kTorque * (m.state.joint[0].position - ahead), 1e-9);
    EXPECT_NEAR(b.driveWork, 0.5 * 0.7 * (m.state.joint[0].rate * m.state.joint[0].rate - 4), 1e-9);
    EXPECT_NEAR(b.integrationError, 0, 1e-9);
  }
}

/// Five links on ball joints and hinges with differing masses, tumbling; hanging from the world or free.
Mechanism chain(bool hanging) {
  Mechanism m;
  const Mat3d I = Mat3d::diagonal({0.01, 0.03, 0.02});
  for (int i = 0; i < 5; ++i)
    m.model.addBody(makeBody("link " + std::to_string(i), 1.0 + 0.3 * i, I, {{0.3 * i + 0.15, 1, 0.5}, {}}, {0, 1, 0}));
  if (hanging) m.model.addJointAt("hook", JointType::kSpherical, kWorld, 0, {{0, 1, 0.5}, {}});
  for (int i = 0; i < 4; ++i)
    m.model.addJointAt("joint " + std::to_string(i), i % 2 == 0 ? JointType::kSpherical : JointType::kRevolute, i,
                       i + 1, frameWithZ({0.3 * (i + 1), 1, 0.5}, {0, 0, 1}));
  m.start();
  if (!hanging) setTwist(m.model, m.state, 4, {{0, 1, 0}, {}});
  return m;
}

TEST(MultibodyLedger, AFreeChainKeepsItsMomentaAndBooksNothingFromOutside) {
  for (const SolverOptions& options : {SolverOptions{}, rattle()}) {
    Mechanism m = chain(false);
    m.loads.gravity = {};
    for (int b = 0; b < 5; ++b)
      setTwist(m.model, m.state, b, {m.state.twist[static_cast<std::size_t>(b)].v, {1, 2, 3}});
    Solver solver(m.model, accepting(options));
    solver.projectVelocities(m.state, m.loads);
    for (int i = 0; i < 10000; ++i) solver.step(m.state, m.loads, 1e-3);
    const Balance b = balance(m.model, m.state, m.loads);
    EXPECT_EQ(m.state.ledger.linearImpulse.value(), (Vec3d{}));
    EXPECT_EQ(m.state.ledger.angularImpulse.value(), (Vec3d{}));
    EXPECT_LE(length(b.linearRemainder), kRounding * length(m.state.ledger.startLinear));
    EXPECT_LE(length(b.angularRemainder), kRounding * length(m.state.ledger.startAngular));
  }
}

// Euler's readings are means over the step, so their sum is the impulse of the hook.
TEST(MultibodyLedger, AHangingChainIsBalancedByItsHook) {
  Mechanism m = chain(true);
  Solver solver(m.model, accepting({}));
  const double step = 1e-3;
  Vec3d hook;
  for (int i = 0; i < 3000; ++i) {
    solver.step(m.state, m.loads, step);
    hook += step * m.state.joint[0].force;
  }
  const Balance b = balance(m.model, m.state, m.loads);
  EXPECT_GT(length(hook), 100);
  const Vec3d weight = 8.0 * 3 * m.loads.gravity;
  EXPECT_LE(length(m.state.ledger.linearImpulse.value() - hook - weight), 1e-10);
  EXPECT_LE(length(b.linearRemainder), 1e-10);
  EXPECT_LE(length(b.angularRemainder), 1e-10);
}

TEST(MultibodyLedger, AChangeThatNobodyBooksIsLeftOver) {
  for (const SolverOptions& options : {SolverOptions{}, rattle()}) {
    Mechanism m = doublePendulum();
    Solver solver(m.model, options);
    for (int i = 0; i < 100; ++i) solver.step(m.state, m.loads, 1e-3);
    const double before = totals(m.model, m.state, m.loads).kinetic;
    Twist faster = m.state.twist[1];
    faster.v *= 1.01, faster.w *= 1.01;
    setTwist(m.model, m.state, 1, faster);
    const double given = totals(m.model, m.state, m.loads).kinetic - before;
    EXPECT_GT(given, 1e-3);
    for (int i = 0; i < 100; ++i) solver.step(m.state, m.loads, 1e-3);
    EXPECT_NEAR(balance(m.model, m.state, m.loads).leftOver, given, 1e-3 * given);
  }
}

// Ramps of preload, stiffness and gravity add energy that is neither stored nor work.
TEST(MultibodyLedger, RampsAreNoIntegrationError) {
  const auto run = [](double step) {
    Mechanism m = springPendulum();
    m.model.addJointAt("unused", JointType::kSpherical, kWorld,
                       m.model.addBody(makeBody("ballast", 1, Mat3d::identity(), {})), {});
    m.start();
    Solver solver(m.model, rattle());
    for (long i = 0; i < std::lround(1 / step); ++i) {
      const double ramp = std::min(1.0, 2 * m.state.time);
      m.loads.gravity = {0, 0, -9.81 * ramp};
      m.loads.pointSprings[0] = {ramp, 0.5 + 0.5 * ramp};
      solver.step(m.state, m.loads, step);
    }
    return balance(m.model, m.state, m.loads);
  };
  const Balance coarse = run(2e-3), fine = run(1e-3);
  EXPECT_LE(std::fabs(fine.leftOver), kRounding * fine.turnover);
  EXPECT_LT(std::fabs(fine.integrationError), 1e-3);
  EXPECT_NEAR(std::log2(coarse.integrationError / fine.integrationError), 2, 0.2);
}

TEST(MultibodyLedger, BooksGoOnWithTheSameBitsFromARestoredState) {
  for (const SolverOptions& options : {SolverOptions{}, rattle(), rattle(4)}) {
    Mechanism straight = oddments();
    Solver solver(straight.model, accepting(options));
    for (int i = 0; i < 200; ++i) solver.step(straight.state, straight.loads, 1e-3);
    Mechanism resumed = oddments();
    resumed.state.restore(straight.state.save());
    Solver another(resumed.model, accepting(options));
    for (int i = 0; i < 200; ++i) {
      solver.step(straight.state, straight.loads, 1e-3);
      another.step(resumed.state, resumed.loads, 1e-3);
    }
    EXPECT_EQ(straight.state.save(), resumed.state.save());
    EXPECT_EQ(balance(straight.model, straight.state, straight.loads).integrationError,
              balance(resumed.model, resumed.state, resumed.loads).integrationError);
  }
}

TEST(MultibodyLedger, AMillionSmallWorksAreSummedLikeOne) {
  CompensatedSum sum;
  double plain = 0;
  sum += 1e6, plain += 1e6;
  for (int i = 0; i < 1000000; ++i) sum += 0.1, plain += 0.1;
  EXPECT_EQ(sum.sum, plain) << "the hash uses the plain sum";
  EXPECT_GT(std::fabs(plain - 1.1e6), 1e-6);
  EXPECT_NEAR(sum, 1.1e6, 1e-9); // rounding of 0.1: 5.6e-18 a million times, and the last place
}

} // namespace
} // namespace grouser::multibody::test

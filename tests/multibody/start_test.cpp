// SPDX-License-Identifier: BSD-3-Clause
#include "benchmarks.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace grouser::multibody::test {
namespace {

const Mat3d kRodInertia = Mat3d::diagonal({0.3, 0.2, 0.25});

std::string refusal(const std::function<void()>& f) {
  try {
    f();
  } catch (const base::InputError& e) {
    return e.what();
  }
  return "not refused";
}

void expectRefused(const std::function<void()>& f, const std::vector<std::string>& words) {
  const std::string message = refusal(f);
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
}

void expectSolverRefuses(const Model& model, const std::vector<std::string>& words,
                         const SolverOptions& options = rattle()) {
  expectRefused([&] { const Solver solver(model, options); }, words);
}

TEST(Start, VelocitiesThatBreakAJointAreRefusedByNameOrProjected) {
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    Model model;
    // The centre of a rod moves along the axis of the rod, away from the pin.
    model.addBody(makeBody("rod", 1, kRodInertia, {{1, 0, 0}, {}}, {0.5, 0, -1}, {0, 1, 0}));
    model.addJointAt("pin", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
    SolverOptions o;
    o.integrator = integrator;
    expectSolverRefuses(model, {"joint 'pin'", "0.5", "'world' and 'rod'", "project"}, o);
    o.startVelocities = StartVelocities::kAccept;
    Solver solver(model, o);
    State state = makeState(model);
    const double lost = solver.projectVelocities(state, makeLoads(model));
    EXPECT_NEAR(lost, 0.5 * 0.5 * 0.5, 1e-14); // only the radial part is lost
    EXPECT_NEAR(state.twist[0].v.z, -1, 1e-14);
    EXPECT_NEAR(state.joint[0].rate, 1, 1e-14);
    EXPECT_LT(solver.velocityError(state), 1e-14);
    o.startVelocities = StartVelocities::kRefuse;
    o.velocityTolerance = 1;
    EXPECT_NO_THROW(const Solver tolerant(model, o));
  }
}

TEST(Start, DrivesThatContradictAreRefusedByName) {
  Drive d;
  d.name = "motor";
  {
    Mechanism m = fourBars(1);
    d.joint = 0, d.speed = 1; // the crank turns at 1 rad/s at the start
    m.model.addDrive(d);
    EXPECT_NO_THROW(const Solver solver(m.model, rattle()));
    d.name = "second motor", d.joint = 1;
    m.model.addDrive(d);
    expectSolverRefuses(m.model, {"drive 'second motor'", "drive 'motor'", "foot 1"});
  }
  {
    Model model;
    model.addBody(makeBody("one", 1, kRodInertia, {}));
    model.addBody(makeBody("two", 1, kRodInertia, {}));
    model.addJointAt("hub 1", JointType::kRevolute, kWorld, 0, {});
    model.addJointAt("hub 2", JointType::kRevolute, kWorld, 1, {});
    Coupling c;
    c.name = "gears", c.joint2 = 1;
    model.addCoupling(c);
    for (int j = 0; j < 2; ++j) {
      Drive each;
      each.name = "motor " + std::to_string(j), each.joint = j;
      model.addDrive(each);
    }
    expectSolverRefuses(model, {"drive 'motor 1'", "coupling 'gears'"});
    Drive again;
    again.name = "again", again.joint = 0;
    expectRefused([&] { model.addDrive(again); }, {"drive 'again'", "'motor 0'"});
  }
  {
    Model model;
    model.addBody(makeBody("door", 1, kRodInertia, {}));
    model.addJointAt("hinge", JointType::kRevolute, kWorld, 0, {});
    model.addJointAt("latch", JointType::kFixed, kWorld, 0, {});
    d.joint = 0, d.speed = 0;
    model.addDrive(d);
    expectSolverRefuses(model, {"drive", "hinge", "already determined"});
  }
}

TEST(Start, DrivenAxesMustStartWhereAndAsFastAsTheirLaws) {
  Drive d;
  d.name = "motor", d.kind = DriveKind::kPosition;
  Model model;
  model.addBody(makeBody("wheel", 1, kRodInertia, {}));
  model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
  Model elsewhere = model, fast = model;
  expectRefused([&] { model.addDrive(d); }, {"drive 'motor'", "law"});
  d.law.polynomial = {0.2};
  elsewhere.addDrive(d);
  expectSolverRefuses(elsewhere, {"drive 'motor'", "0.2", "hub"});
  d.law.polynomial = {0, 3};
  fast.addDrive(d);
  expectSolverRefuses(fast, {"hub", "imposes 3"});
}

TEST(Start, FramesThatDoNotMeetAreRefused) {
  {
    Model model;
    model.addBody(makeBody("link", 1, kRodInertia, {}));
    model.addJoint({"rod", JointType::kDistance, kWorld, 0, {{0, 0, 1}, {}}, {}, 0, 0, 1.01});
    expectSolverRefuses(model, {"joint 'rod'", "distance", "gap", "0.01"});
  }
  {
    Model model;
    model.addBody(makeBody("link", 1, kRodInertia, {}));
    model.addJoint({"rod", JointType::kDistance, kWorld, 0, {{0, 0, 1}, {}}, {{0, 0, 1}, {}}, 0, 0, 1});
    expectSolverRefuses(model, {"joint 'rod'", "gap"});
    expectRefused(
        [&] {
          model.addJoint({"short", JointType::kDistance, kWorld, 0, {}, {}});
        },
        {"coincide", "spherical"});
  }
  {
    // Half a turn about x: the dot products of the angle rows vanish, although z points the opposite way.
    Model model;
    model.addBody(makeBody("link", 1, kRodInertia, {{}, {0, 1, 0, 0}}));
    model.addJoint({"weld", JointType::kFixed, kWorld, 0, {}, {}});
    expectSolverRefuses(model, {"joint 'weld'", "opposite"});
  }
  {
    Model model;
    model.addBody(makeBody("nut", 1, kRodInertia, {}));
    model.addJoint({"bar", JointType::kCylindrical, kWorld, 0, {}, {}});
    Coupling c;
    c.name = "thread", c.axis1 = JointAxis::kAngle, c.axis2 = JointAxis::kSlide, c.ratio = 0.01, c.offset = 0.2;
    model.addCoupling(c);
    expectSolverRefuses(model, {"coupling 'thread'", "-0.2", "offset"});
  }
}

TEST(Start, AxesMustBeNamedWhereThereAreTwoAndExistWhereTheyAreNamed) {
  Model model;
  model.addBody(makeBody("nut", 1, kRodInertia, {}));
  model.addBody(makeBody("wheel", 1, kRodInertia, {}));
  const int bar = model.addJoint({"bar", JointType::kCylindrical, kWorld, 0, {}, {}});
  const int hub = model.addJoint({"hub", JointType::kRevolute, kWorld, 1, {}, {}});
  AxisSpring s;
  s.name = "spring", s.joint = bar, s.stiffness = 1;
  expectRefused([&] { model.addAxisSpring(s); }, {"spring 'spring'", "'bar'", "angle or slide"});
  s.joint = hub, s.axis = JointAxis::kSlide;
  expectRefused([&] { model.addAxisSpring(s); }, {"'hub'", "no free slide"});
  Coupling c;
  c.name = "gears", c.joint1 = hub, c.joint2 = hub;
  expectRefused([&] { model.addCoupling(c); }, {"'gears'", "itself"});
  c.joint1 = bar, c.axis1 = JointAxis::kSlide, c.ratio = 0;
  expectRefused([&] { model.addCoupling(c); }, {"'gears'", "ratio"});
}

TEST(Start, PointBodiesAreHeldAtTheirOriginOnly) {
  Model model;
  Body bob = makeBody("bob", 1, {}, {{0, 0, -1}, {}});
  bob.point = true;
  model.addBody(bob);
  expectRefused([&] { model.addJointAt("pin", JointType::kRevolute, kWorld, 0, {}); }, {"'bob'", "point", "inertia"});
  expectRefused([&] { model.addJointAt("ball", JointType::kSpherical, kWorld, 0, {}); }, {"'bob'", "origin"});
  EXPECT_NO_THROW(model.addJoint({"rod", JointType::kDistance, kWorld, 0, {}, {}}));
  bob.name = "spinning", bob.w_WB = {1, 0, 0};
  expectRefused([&] { model.addBody(bob); }, {"'spinning'", "rotate"});
}

TEST(Start, LawsAreChecked) {
  Drive d;
  d.name = "motor", d.law.table = {{0, 1, 1}, {0, 1, 2}};
  Model model;
  model.addBody(makeBody("wheel", 1, kRodInertia, {}));
  model.addJointAt("hub", JointType::kRevolute, kWorld, 0, {});
  expectRefused([&] { model.addDrive(d); }, {"drive 'motor'", "table", "increase"});
  d.law.table = {{0, 1}, {0}};
  expectRefused([&] { model.addDrive(d); }, {"drive 'motor'", "2 times and 1 values"});
}

TEST(TimeLaws, RateAndIntegralBelongToTheValue) {
  TimeLaw law;
  law.polynomial = {0.3, -1, 0.5, 0.2};
  law.harmonics = {{0.4, 5, 0.3}, {0.1, 0, 1}};
  law.table = {{-0.5, 0.4, 1.1, 2.5}, {0.2, 1, -0.3, 0.4}};
  law.ramps = {{0.1, 1.4, 2.2}, {0, 2, 1}};
  const double h = 1e-5;
  for (const double t : {-0.7, -0.2, 0.05, 0.77, 1.9, 2.9}) {
    // Central differences: h^2 / 6 times third derivatives of some tens, and 1e-16 / h.
    EXPECT_NEAR(law.rate(t), (law.value(t + h) - law.value(t - h)) / (2 * h), 5e-9) << t;
    EXPECT_NEAR(law.acceleration(t), (law.rate(t + h) - law.rate(t - h)) / (2 * h), 5e-8) << t;
    EXPECT_NEAR(law.value(t), (law.integral(t + h) - law.integral(t - h)) / (2 * h), 5e-9) << t;
  }
  EXPECT_EQ(law.integral(0), 0);
  for (std::size_t i = 0; i < law.table.times.size(); ++i) {
    const TimeLaw spline{{}, {}, law.table, {}};
    EXPECT_NEAR(spline.value(law.table.times[i]), law.table.values[i], 1e-15);
  }
}

TEST(TimeLaws, ATableOfPositionsBeginsAndEndsAtRest) {
  const TimeLaw law{{}, {}, {{0, 1, 2, 3}, {0, 0.5, 0.2, 0.2}}, {}};
  // From both sides of the ends and of all times in between: a jump of the rate would be an impact.
  for (const double t : {0.0, 1.0, 2.0, 3.0}) {
    const double before = law.rate(t - 1e-9), after = law.rate(t + 1e-9); // curvature of 10 times 2e-9
    EXPECT_NEAR(before, after, 1e-7) << t;
    if (t == 0 || t == 3) {
      EXPECT_NEAR(law.rate(t), 0, 1e-14) << t;
    }
  }
  // Only two positions: half-way after half the time, at 1.5 times the mean rate.
  const TimeLaw two{{}, {}, {{0, 2}, {0, 1}}, {}};
  EXPECT_NEAR(two.value(1), 0.5, 1e-15);
  EXPECT_NEAR(two.rate(1), 0.75, 1e-15);
}

TEST(SavedStates, ARunResumedGivesTheSameBitsWithEveryKindOfPart) {
  const auto build = [](Model& model) {
    Body bob = makeBody("bob", 1, {}, {{0.5, 0, -1}, {}});
    bob.point = true;
    model.addBody(makeBody("nut", 1, kRodInertia, {}));
    model.addBody(makeBody("frame", 2, kRodInertia, {{0, 1, 0}, {}}));
    model.addBody(bob);
    model.addBody(makeBody("wheel", 1, kRodInertia, {{0, 3, 0}, {}}));
    model.addJoint({"bar", JointType::kCylindrical, kWorld, 0, {}, {}, 0.1, 0.2});
    model.addJoint({"rod", JointType::kDistance, 1, 2, {}, {}});
    model.addJointAt("hub", JointType::kRevolute, kWorld, 3, {{0, 3, 0}, {}});
    Bushing b;
    b.name = "mount", b.bodyB = 1, b.frame_A.position = {0, 1, 0}, b.stiffness = {500, 400, 600}, b.damping = {1, 2, 3};
    b.rotationStiffness = {30, 40, 50};
    model.addBushing(b);
    AxisSpring s;
    s.name = "stop", s.joint = 0, s.axis = JointAxis::kSlide, s.lowerLimit = -0.2, s.stopStiffness = 1e5;
    model.addAxisSpring(s);
    Coupling c;
    c.name = "belt", c.joint1 = 0, c.axis1 = JointAxis::kAngle, c.joint2 = 2, c.ratio = 3;
    model.addCoupling(c);
    Drive d;
    d.name = "motor", d.joint = 2, d.kind = DriveKind::kForce, d.law.harmonics = {{2, 3, 0}};
    model.addDrive(d);
  };
  for (const int order : {0, 2, 4}) {
    SolverOptions o = rattle(order == 0 ? 2 : order);
    if (order == 0) o.integrator = Integrator::kSymplecticEuler;
    Model model, again;
    build(model), build(again);
    Solver first(model, o);
    State state = makeState(model);
    const Loads loads = makeLoads(model);
    for (int i = 0; i < 300; ++i) first.step(state, loads, 1e-3);
    State copy = makeState(again);
    copy.restore(state.save());
    Solver second(again, o);
    for (int i = 0; i < 300; ++i) first.step(state, loads, 1e-3), second.step(copy, loads, 1e-3);
    EXPECT_EQ(state.save(), copy.save()) << "order " << order;
    EXPECT_NE(state.slide[0].position, 0);
    EXPECT_NE(length(state.bushing[0].force), 0);
    EXPECT_NE(state.coupling[0].force, 0);
  }
}

} // namespace
} // namespace grouser::multibody::test

// SPDX-License-Identifier: BSD-3-Clause
// Reactions of redundant joints: minimum norm.
#include "benchmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace grouser::multibody::test {
namespace {

/// A door of 20 kg at rest, with its centre of mass `out` [m] from the line of its hinges.
Mechanism doorOn(const std::vector<double>& hinges, double out = 0.45) {
  Mechanism m;
  m.model.addBody(makeBody("door", 20, Mat3d::diagonal({7, 8, 1.1}), {{out, 0, 1}, {}}));
  for (const double z : hinges)
    m.model.addJointAt("hinge at " + std::to_string(z), JointType::kRevolute, kWorld, 0, {{0, 0, z}, {}});
  m.start();
  return m;
}

/// Force, and moment about the world's origin, of all joints on a body.
JointReaction sumOn(const Mechanism& m, int body, const std::vector<JointReaction>& reactions) {
  JointReaction sum;
  for (std::size_t j = 0; j < reactions.size(); ++j) {
    const Joint& joint = m.model.joints()[j];
    const Vec3d p = joint.bodyB == kWorld
                        ? joint.frame_B.position
                        : m.state.pose[static_cast<std::size_t>(joint.bodyB)].toWorld(joint.frame_B.position);
    const double sign = joint.bodyB == body ? 1 : joint.bodyA == body ? -1 : 0;
    sum.force += sign * reactions[j].force;
    sum.torque += sign * (reactions[j].torque + cross(p, reactions[j].force));
  }
  return sum;
}

std::vector<JointReaction> asRead(const State& state) {
  std::vector<JointReaction> read;
  for (const JointReading& joint : state.joint) read.push_back({joint.force, joint.torque});
  return read;
}

/// Equal hinges at z_i above their centre each have -kappa z_i horizontally and the moment -kappa L^2, with
/// kappa (sum z_i^2 + n L^2) = W b: Lagrange's conditions of the minimum norm.
TEST(RedundantReactions, SymmetricDoorsShareTheirWeight) {
  const double b = 0.45, W = 20 * 9.81;
  for (const std::vector<double>& hinges : {std::vector<double>{0.2, 1.8}, std::vector<double>{0.2, 1.0, 1.8}})
    for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle})
      for (const double given : {0.0, 0.8, 1e-3}) {
        Mechanism m = doorOn(hinges, b);
        SolverOptions o;
        o.integrator = integrator, o.momentLength = given;
        Solver solver(m.model, o);
        solver.step(m.state, m.loads, 1e-3);
        const double n = static_cast<double>(hinges.size());
        // Distances of 1.6 m; of 0.8, 0.8, 1.6 m.
        const double L2 = given > 0 ? given * given : n == 2 ? 1.6 * 1.6 : 2 * 0.8 * 0.8;
        const double kappa = W * b / (2 * 0.8 * 0.8 + n * L2);
        const std::vector<JointReaction> shared = solver.reactions(m.state);
        for (std::size_t i = 0; i < hinges.size(); ++i) {
          // Round-off of the balance, which the solver closes to some 1e-12 of the weight.
          EXPECT_LT(length(shared[i].force - Vec3d{-kappa * (hinges[i] - 1), 0, W / n}), 1e-10 * W) << i;
          EXPECT_LT(length(shared[i].torque - Vec3d{0, -kappa * L2, 0}), 1e-10 * W) << i;
        }
        // Without this option the first hinge carries all.
        EXPECT_LT(length(m.state.joint[1].force), 1e-10 * W);
      }
  // A length much smaller than the door: a couple of forces, as on hinges without moments.
  Mechanism m = doorOn({0.2, 1.8}, b);
  SolverOptions o;
  o.momentLength = 1e-4;
  Solver solver(m.model, o);
  solver.step(m.state, m.loads, 1e-3);
  EXPECT_NEAR(solver.reactions(m.state)[0].force.x, W * b / 1.6, 1e-7 * W);
}

TEST(RedundantReactions, BalanceInMotionWhatTheReadingsBalance) {
  // A swinging door, and a chain of four-bars through positions with all rods in line.
  Mechanism door = doorOn({0.2, 1.0, 1.8});
  setTwist(door.model, door.state, 0, {{0, 0.9, 0}, {0, 0, 2}});
  Mechanism bars = fourBars(3);
  for (Mechanism* m : {&door, &bars}) {
    Solver solver(m->model, rattle());
    double worst = 0, changed = 0;
    for (int i = 0; i < 2000; ++i) {
      solver.step(m->state, m->loads, 1e-3);
      if (i % 10 != 0) continue;
      const std::vector<JointReaction> shared = solver.reactions(m->state), read = asRead(m->state);
      double largest = 1;
      for (const JointReaction& r : read) largest = std::max({largest, length(r.force), length(r.torque)});
      for (int body = 0; body < static_cast<int>(m->model.bodies().size()); ++body) {
        const JointReaction a = sumOn(*m, body, shared), c = sumOn(*m, body, read);
        worst = std::max({worst, length(a.force - c.force) / largest, length(a.torque - c.torque) / largest});
      }
      changed = std::max(changed, length(shared.back().force - read.back().force));
    }
    EXPECT_LT(worst, 1e-11);
    EXPECT_EQ(changed > 1, m == &door); // forces across the plane of the four-bars are zero
  }
  // m (a - g), with the centripetal acceleration of the centre of mass.
  Solver solver(door.model, rattle());
  solver.step(door.state, door.loads, 1e-3);
  const Vec3d out = door.state.pose[0].position - Vec3d{0, 0, 1};
  const double w = door.state.twist[0].w.z;
  const Vec3d sum = sumOn(door, 0, solver.reactions(door.state)).force;
  EXPECT_LT(length(sum - (Vec3d{0, 0, 20 * 9.81} - 20 * w * w * out)), 1e-9);
}

/// A beam on five uprights where two suffice, with its joints in one order or the other.
Mechanism uprights(bool reversed) {
  Mechanism m;
  m.model.addBody(makeBody("beam", 3, Mat3d::diagonal({0.1, 1, 1}), {{2, 0, 1}, {}}));
  for (int i = 0; i < 5; ++i) addRod(m.model, "upright " + std::to_string(i), {1.0 * i, 0, 0}, {1.0 * i, 0, 1});
  for (int n = 0; n < 5; ++n) {
    const int i = reversed ? 4 - n : n;
    m.model.addJointAt("foot " + std::to_string(i), JointType::kRevolute, kWorld, 1 + i,
                       frameWithZ({1.0 * i, 0, 0}, kY));
    m.model.addJointAt("head " + std::to_string(i), JointType::kRevolute, 1 + i, 0, frameWithZ({1.0 * i, 0, 1}, kY));
  }
  m.start();
  m.loads.external[0] = {{5, 70, -30}, {20, 10, 40}};
  return m;
}

TEST(RedundantReactions, AreTheSameWhicheverRowsTheSolverLeavesOut) {
  Mechanism one = uprights(false), other = uprights(true);
  Solver first(one.model, rattle()), second(other.model, rattle());
  double difference = 0, readings = 0;
  for (int i = 0; i < 200; ++i) {
    first.step(one.state, one.loads, 1e-3);
    second.step(other.state, other.loads, 1e-3);
    const std::vector<JointReaction> a = first.reactions(one.state), b = second.reactions(other.state);
    for (const Joint& joint : one.model.joints()) {
      const auto j = static_cast<std::size_t>(one.model.jointIndex(joint.name)),
                 k = static_cast<std::size_t>(other.model.jointIndex(joint.name));
      difference = std::max({difference, length(a[j].force - b[k].force), length(a[j].torque - b[k].torque)});
      readings = std::max(readings, length(one.state.joint[j].force - other.state.joint[k].force));
    }
  }
  EXPECT_LT(difference, 1e-8); // forces are some 100 N; the two motions diverge by round-off
  EXPECT_GT(readings, 1);
}

/// A parallelogram folded almost flat: rotating its coupler requires a torque of rods with a lever arm of `angle`.
TEST(RedundantReactions, BalanceNextToASingularPosition) {
  const double angle = 1e-5, torque = 1;
  Mechanism m;
  const Vec3d up{std::cos(angle), 0, std::sin(angle)};
  addRod(m.model, "crank", {0, 0, 0}, up);
  addRod(m.model, "rocker", {1, 0, 0}, Vec3d{1, 0, 0} + up);
  addRod(m.model, "coupler", up, Vec3d{1, 0, 0} + up);
  m.model.addJointAt("foot 1", JointType::kRevolute, kWorld, 0, frameWithZ({}, kY));
  m.model.addJointAt("foot 2", JointType::kRevolute, kWorld, 1, frameWithZ({1, 0, 0}, kY));
  m.model.addJointAt("head 1", JointType::kRevolute, 0, 2, frameWithZ(up, kY));
  m.model.addJointAt("head 2", JointType::kRevolute, 1, 2, frameWithZ(Vec3d{1, 0, 0} + up, kY));
  m.start();
  m.loads.gravity = {};
  m.loads.external[2].torque = {0, torque, 0};
  Solver solver(m.model, rattle());
  solver.step(m.state, m.loads, 1e-5);
  const std::vector<JointReaction> shared = solver.reactions(m.state), read = asRead(m.state);
  EXPECT_GT(length(read[2].force), 0.1 * torque / angle);
  for (int body = 0; body < 3; ++body) {
    const JointReaction a = sumOn(m, body, shared), c = sumOn(m, body, read);
    // Round-off of forces of 1e5 N.
    EXPECT_LT(length(a.force - c.force), 1e-9) << body;
    EXPECT_LT(length(a.torque - c.torque), 1e-9) << body;
  }
}

TEST(RedundantReactions, LeaveTheOthersUnchangedToTheBit) {
  // A pendulum of two rods on a door: its pins belong to no loop.
  for (const bool redundant : {false, true}) {
    Mechanism m = doorOn(redundant ? std::vector<double>{0.2, 1.8} : std::vector<double>{0.2});
    addRod(m.model, "upper", {0.9, 0, 1}, {0.9, 0, 0});
    addRod(m.model, "lower", {0.9, 0, 0}, {1.5, 0, -0.8});
    m.model.addJointAt("upper pin", JointType::kSpherical, 0, 1, frameWithZ({0.9, 0, 1}, kY));
    m.model.addJointAt("lower pin", JointType::kUniversal, 1, 2, frameWithZ({0.9, 0, 0}, {1, 2, 3}));
    m.start();
    m.loads.external[2] = {{1, 2, 3}, {0.3, 0.2, 0.1}};
    Solver solver(m.model, rattle());
    int different = 0;
    for (int i = 0; i < 200; ++i) {
      solver.step(m.state, m.loads, 1e-3);
      const std::vector<JointReaction> shared = solver.reactions(m.state), read = asRead(m.state);
      for (std::size_t j = redundant ? 2 : 0; j < shared.size(); ++j)
        different += !(shared[j].force == read[j].force && shared[j].torque == read[j].torque);
      EXPECT_EQ(length(shared[0].force - read[0].force) > 1, redundant);
    }
    EXPECT_EQ(different, 0);
  }
}

TEST(RedundantReactions, ADrivenFourBarKeepsWhatItsPlaneDetermines) {
  const auto fourBar = [](bool redundant) {
    Mechanism m;
    addRod(m.model, "crank", {0, 0, 0}, {0, 0, 1});
    addRod(m.model, "coupler", {0, 0, 1}, {2, 0, 2});
    addRod(m.model, "rocker", {2, 0, 2}, {2, 0, 0});
    m.model.addJointAt("a", JointType::kRevolute, kWorld, 0, frameWithZ({0, 0, 0}, kY));
    m.model.addJointAt("b", JointType::kRevolute, 0, 1, frameWithZ({0, 0, 1}, kY));
    m.model.addJointAt("c", redundant ? JointType::kRevolute : JointType::kSpherical, 1, 2, frameWithZ({2, 0, 2}, kY));
    // It also turns about y, across its x axis: cylindrical allows sliding along y.
    m.model.addJointAt("d", redundant ? JointType::kRevolute : JointType::kCylindrical, kWorld, 2,
                       frameWithZ({2, 0, 0}, kY));
    Drive drive;
    drive.name = "motor", drive.joint = 0, drive.speed = 3;
    m.model.addDrive(drive);
    m.start();
    return m;
  };
  Mechanism m = fourBar(true), plain = fourBar(false);
  SolverOptions o = rattle();
  o.startVelocities = StartVelocities::kAccept;
  Solver solver(m.model, o), reference(plain.model, o);
  ASSERT_EQ(solver.redundantRowNames().size(), 3u);
  ASSERT_EQ(reference.redundantRowNames().size(), 0u);
  solver.projectVelocities(m.state, m.loads), reference.projectVelocities(plain.state, plain.loads);
  for (int i = 0; i < 300; ++i) {
    solver.step(m.state, m.loads, 1e-3);
    reference.step(plain.state, plain.loads, 1e-3);
  }
  std::vector<JointReaction> shared = solver.reactions(m.state), sound = reference.reactions(plain.state);
  for (std::size_t j = 0; j < 4; ++j) {
    // Some 30 N; the two runs diverge by round-off.
    EXPECT_LT(length(shared[j].force - sound[j].force), 1e-8) << j;
    EXPECT_NEAR(shared[j].torque.y, sound[j].torque.y, 1e-8) << j;
  }
  EXPECT_NEAR(driveForce(m.model, m.state, 0), shared[0].torque.y, 1e-8);

  // Across the plane both feet share the coupler's load.
  m.loads.external[1].force.y = 100;
  solver.step(m.state, m.loads, 1e-3);
  shared = solver.reactions(m.state);
  EXPECT_NEAR(shared[0].force.y + shared[3].force.y, -100, 1e-8);
  EXPECT_LT(shared[0].force.y, -20);
  EXPECT_LT(shared[3].force.y, -20);
}

TEST(RedundantReactions, AskingForThemDoesNotMoveABitOfTheMotion) {
  for (const Integrator integrator : {Integrator::kSymplecticEuler, Integrator::kRattle}) {
    Mechanism asked = uprights(false), quiet = uprights(false);
    SolverOptions o;
    o.integrator = integrator;
    Solver a(asked.model, o), b(quiet.model, o);
    for (int i = 0; i < 300; ++i) {
      a.step(asked.state, asked.loads, 1e-3);
      EXPECT_EQ(a.reactions(asked.state).size(), 10u);
      b.step(quiet.state, quiet.loads, 1e-3);
    }
    EXPECT_EQ(asked.state.save(), quiet.state.save());
  }
}

} // namespace
} // namespace grouser::multibody::test

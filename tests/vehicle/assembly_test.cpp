// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/assembly.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "multibody/readings.hpp"
#include "multibody/solver.hpp"
#include "tests/vehicle/ground_shoes.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace grouser;
using base::Vec3d;
using multibody::JointType;
using vehicle::Assembly;
using vehicle::AssemblyOptions;
using vehicle::PartKind;

namespace {

const Vec3d kGravity{0, 0, -9.81};

vehicle::VehicleSpec spec() {
  return vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml");
}

AssemblyOptions leftOnly(bool fixChassis) {
  AssemblyOptions options;
  options.fixChassis = fixChassis;
  options.right = false;
  return options;
}

/// No preload anywhere, sprockets locked.
multibody::Loads relaxed(const Assembly& v, const Vec3d& gravity) {
  multibody::Loads loads = multibody::makeLoads(v.model);
  vehicle::Controls controls;
  controls.tension = 0, controls.weight = 0;
  vehicle::applyControls(v, controls, gravity, loads);
  loads.gravity = gravity;
  return loads;
}

int rows(JointType type) {
  switch (type) {
  case JointType::kSpherical:
    return 3;
  case JointType::kUniversal:
  case JointType::kCylindrical:
    return 4;
  case JointType::kDistance:
    return 1;
  case JointType::kRevolute:
  case JointType::kPrismatic:
    return 5;
  case JointType::kFixed:
    return 6;
  }
  return 0;
}

} // namespace

TEST(Assembly, LightVehicle_HasAllPartsAndItsMass) {
  const Assembly v = vehicle::assemble(spec());
  EXPECT_EQ(v.model.bodies().size(), 1u + 2 * (46 + 5 + 5 + 3 + 1 + 1 + 1));
  EXPECT_EQ(v.parts.size(), 1u + 2 * (46 + 5 + 3 + 1 + 1));
  EXPECT_EQ(v.pairs.size(), 2u * 46 * (5 + 3 + 1 + 1));
  EXPECT_EQ(v.groundParts.size(), 92u);
  // Sum of 125 decimal masses: round-off of 5e3.
  EXPECT_NEAR(v.mass, 5018.0, 1e-10);
  for (const vehicle::PartPair& pair : v.pairs) {
    EXPECT_EQ(v.parts[pair.shoe].kind, PartKind::kShoe);
    EXPECT_NE(v.parts[pair.other].kind, PartKind::kShoe);
    EXPECT_EQ(v.parts[pair.shoe].track, v.parts[pair.other].track);
  }
}

TEST(Assembly, DegreesOfFreedom_AreThoseOfTheMechanism) {
  const Assembly v = vehicle::assemble(spec());
  int freedoms = 6 * static_cast<int>(v.model.bodies().size());
  for (const multibody::Joint& joint : v.model.joints()) freedoms -= rows(joint.type);
  // Chassis 6; a track: arms 5, wheels 5, rollers 3, sprocket, slide, idler, and a ring of 46 links: 46 in its plane
  // (46 links x 3 - 46 pins x 2) and the 3 of a rigid body out of it.
  EXPECT_EQ(freedoms, 6 + 2 * (5 + 5 + 3 + 1 + 1 + 1 + 49));
  const multibody::Solver solver(v.model);
  EXPECT_EQ(solver.redundantRowNames().size(), 0u) << solver.report();
}

TEST(Assembly, AnyPlaceAndHeading_StartsWithEveryJointClosed) {
  AssemblyOptions options;
  options.pose_W = vehicle::placeOnGround(spec(), 3.0, -2.0, 0.7, 0.002, 0.6);
  const Assembly v = vehicle::assemble(spec(), options);
  for (const multibody::Joint& joint : v.model.joints()) {
    const auto& bodies = v.model.bodies();
    const base::Pose a = multibody::compose(bodies[joint.bodyA].pose, joint.frame_A);
    const base::Pose b = multibody::compose(bodies[joint.bodyB].pose, joint.frame_B);
    // Round-off of positions 6 m from the origin.
    EXPECT_LT(base::norm(a.position - b.position), 1e-14 * 6) << joint.name;
    const Vec3d z_A = base::rotate(a.orientation, {0, 0, 1}), z_B = base::rotate(b.orientation, {0, 0, 1});
    EXPECT_LT(base::norm(z_A - z_B), 1e-14) << joint.name;
  }
}

TEST(Assembly, PlaceOnGround_PutsTheGrousersThere) {
  AssemblyOptions options;
  options.pose_W = vehicle::placeOnGround(spec(), 0, 0, 0.7, 0.002, -1.1);
  const Assembly v = vehicle::assemble(spec(), options);
  double lowest = 1e9;
  for (const int part : v.groundParts) lowest = std::min(lowest, v.model.bodies()[v.parts[part].body].pose.position.z);
  EXPECT_NEAR(lowest - 0.055, 0.702, 1e-14);
}

TEST(Assembly, Wheels_StandOnTheirPlates) {
  const Assembly v = vehicle::assemble(spec());
  const auto& bodies = v.model.bodies();
  const vehicle::Track& left = v.tracks[0];
  EXPECT_EQ(bodies[left.wheels[0]].pose.position.z - 0.19,
            bodies[left.shoes[test::firstGroundShoe(v.wrap)]].pose.position.z + 0.02);
  EXPECT_GT(bodies[left.shoes[0]].pose.position.y, 0) << "left is at positive y";
}

TEST(Assembly, RelaxedFreeFall_AllBodiesFallAlikeWithoutJointForces) {
  AssemblyOptions options;
  options.velocity = {0.5, 0, 0};
  const Assembly v = vehicle::assemble(spec(), options);
  multibody::Solver solver(v.model);
  multibody::State state = multibody::makeState(v.model);
  const multibody::Loads loads = relaxed(v, kGravity);
  const int steps = 200;
  const double dt = 5e-5;
  for (int i = 0; i < steps; ++i) solver.step(state, loads, dt);
  for (std::size_t i = 0; i < state.twist.size(); ++i) {
    // Round-off of positions 3 m from the origin, 4e-16 m over a step, some hundred times.
    EXPECT_LT(base::norm(state.twist[i].v - Vec3d{0.5, 0, -9.81 * steps * dt}), 1e-9) << v.model.bodies()[i].name;
    EXPECT_LT(base::norm(state.twist[i].w), 1e-9) << v.model.bodies()[i].name;
  }
  for (std::size_t i = 0; i < state.joint.size(); ++i)
    // The same round-off as an acceleration, 4e-16 m / dt^2 = 2e-7 m/s2, of a ring of 391 kg; the weight is 5e4 N.
    EXPECT_LT(base::norm(state.joint[i].force), 1e-3) << v.model.joints()[i].name;
}

TEST(Assembly, PreloadsReleasedInFlight_KeepMomentum) {
  const Assembly v = vehicle::assemble(spec());
  multibody::Solver solver(v.model);
  multibody::State state = multibody::makeState(v.model);
  multibody::Loads loads = multibody::makeLoads(v.model);
  vehicle::applyControls(v, {}, {}, loads);
  const multibody::Totals before = multibody::totals(v.model, state, loads);
  for (int i = 0; i < 200; ++i) solver.step(state, loads, 1e-4);
  const multibody::Totals after = multibody::totals(v.model, state, loads);
  EXPECT_GT(after.kinetic, 0.1) << "tensioner and torsion bars must cause motion";
  // Round-off of internal impulses, 2e4 N over 0.02 s in 200 steps.
  EXPECT_LT(base::norm(after.linearMomentum - before.linearMomentum), 1e-7);
  EXPECT_LT(base::norm(after.angularMomentum - before.angularMomentum), 1e-6);
}

TEST(Assembly, ArmPreload_PushesTheWheelDown) {
  const Assembly v = vehicle::assemble(spec(), leftOnly(true));
  multibody::Solver solver(v.model);
  multibody::State state = multibody::makeState(v.model);
  multibody::Loads loads = multibody::makeLoads(v.model);
  vehicle::applyControls(v, {}, {}, loads);
  solver.step(state, loads, 1e-5);
  for (const int wheel : v.tracks[0].wheels) EXPECT_LT(state.twist[wheel].v.z, 0);
  // The tensioner pushes forward with its preload.
  EXPECT_GT(state.twist[v.tracks[0].idler].v.x, 0);
  EXPECT_NEAR(state.joint[v.tracks[0].slideJoint].springForce, 9200, 50);
}

TEST(Assembly, ForwardDrive_TakesTheTopForward) {
  const Assembly v = vehicle::assemble(spec(), leftOnly(true));
  multibody::Solver solver(v.model);
  multibody::State state = multibody::makeState(v.model);
  multibody::Loads loads = relaxed(v, {});
  vehicle::Controls controls;
  controls.tension = 0, controls.weight = 0;
  controls.sprocketSpeed = {2, 0};
  vehicle::applyControls(v, controls, {}, loads);
  solver.step(state, loads, 1e-4);
  const Vec3d w = state.twist[v.tracks[0].sprocket].w;
  EXPECT_NEAR(base::cross(w, {0, 0, 0.25}).x, 0.5, 1e-9);
  EXPECT_NEAR(state.joint[v.tracks[0].sprocketJoint].rate, 2, 1e-9);
}

TEST(Assembly, HangingOnAFixedChassis_FallsAndLosesEnergyOnly) {
  const Assembly v = vehicle::assemble(spec(), leftOnly(true));
  multibody::Solver solver(v.model);
  multibody::State state = multibody::makeState(v.model);
  const multibody::Loads loads = relaxed(v, kGravity);
  const multibody::Totals start = multibody::totals(v.model, state, loads);
  const double dt = 1e-4;
  for (int i = 0; i < 1000; ++i) solver.step(state, loads, dt);
  const multibody::Totals end = multibody::totals(v.model, state, loads);
  // Nothing supports the loop except its own pins, which have no stiffness: after 0.1 s it has fallen some 49 mm.
  EXPECT_LT(state.pose[v.tracks[0].shoes[40]].position.z,
            v.model.bodies()[v.tracks[0].shoes[40]].pose.position.z - 0.02);
  EXPECT_GT(end.kinetic, 1.0);
  EXPECT_LT(end.kinetic + end.gravity + end.elastic, start.kinetic + start.gravity + start.elastic);
  // The ledger closes to the first order of the step: g dt over the speed reached.
  const double released = start.gravity - end.gravity;
  EXPECT_NEAR(end.kinetic,
              state.ledger.gravityWork + state.ledger.springWork + state.ledger.driveWork - state.ledger.dissipated,
              0.01 * released);
}

TEST(Assembly, NoTrackAskedFor_IsRefused) {
  AssemblyOptions options;
  options.left = options.right = false;
  EXPECT_THROW(vehicle::assemble(spec(), options), base::InputError);
}

TEST(Assembly, PartPose_PutsTheChassisMeshAtTheVehicleFrame) {
  AssemblyOptions options;
  options.pose_W = vehicle::placeOnGround(spec(), 1, 2, 0, 0, 0.3);
  const Assembly v = vehicle::assemble(spec(), options);
  const multibody::State state = multibody::makeState(v.model);
  const base::Pose pose = vehicle::partPose(v.parts[0], state);
  EXPECT_LT(base::norm(pose.position - options.pose_W.position), 1e-14);
}

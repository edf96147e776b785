// SPDX-License-Identifier: BSD-3-Clause
// Every quantity of the vehicle with distinct values: by track, by shoe and by axis. The expected
// numbers follow from the vehicle's drawing and the prescribed state, not from the observers.
#include "vehicle/observation_table.hpp"
#include "vehicle/observers.hpp"

#include "base/math.hpp"
#include "tests/vehicle/attitude.hpp"
#include "tests/vehicle/ground_shoes.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using namespace grouser;
using base::Quat;
using base::Vec3d;
using vehicle::GroundLoads;
using vehicle::Observer;
using vehicle::testing::about;

namespace {

/// Rotated by heading, nose up, right side down, in this order.
Quat attitude(double heading, double pitch, double roll) {
  return about(2, heading) * about(1, -pitch) * about(0, roll);
}

class ObserverValues : public ::testing::Test {
protected:
  vehicle::Assembly v =
      vehicle::assemble(vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  multibody::State state = multibody::makeState(v.model);
  const vehicle::Track &left = v.tracks[0], &right = v.tracks[1];
  /// Ten teeth of 154 mm per turn [m].
  static constexpr double kPitchRadius = 10 * 0.154 / (2 * base::kPi);
  /// Round-off of a few operations on numbers up to 1e4.
  static constexpr double kRound = 1e-11;

  /// Sets the poses of all bodies relative to a vehicle frame at `pose`.
  void place(const base::Pose& pose) {
    for (base::Pose& body : state.pose) body = multibody::compose(pose, body);
  }
  GroundLoads noLoads() const {
    GroundLoads ground;
    ground.force.resize(v.model.bodies().size());
    return ground;
  }
};

TEST_F(ObserverValues, TensionIsThePullAlongTheChainInThePinAheadOfEachShoe) {
  const Quat R = attitude(0.7, 0.2, -0.1);
  place({{5, -3, 2}, R});
  const Vec3d left_W = base::rotate(R, {0, 1, 0});
  const auto pull = [](std::size_t track, std::size_t i) { return static_cast<double>(i + 1 + 100 * track); };
  for (std::size_t track = 0; track < 2; ++track)
    for (std::size_t i = 0; i < 46; ++i) {
      // The pin ahead of shoe i joins it to shoe i + 1. Equal shoes: the bisector of their axes connects their centres.
      const vehicle::Track& t = v.tracks[track];
      const int joint = t.shoeJoints[i], behind = t.shoes[i], ahead = t.shoes[(i + 1) % 46];
      EXPECT_EQ(v.model.joints()[joint].bodyA, behind);
      EXPECT_EQ(v.model.joints()[joint].bodyB, ahead);
      const Vec3d way = state.pose[ahead].position - state.pose[behind].position, along = way * (1 / base::norm(way));
      // Force on the shoe ahead: backward by the pull; radial and lateral forces are no tension.
      state.joint[joint].force =
          (base::cross(along, left_W) * 4.0 + left_W * (i % 2 ? 12.0 : -7.0) - along) * pull(track, i);
    }
  const auto o = Observer(v).observe(state, {}, nullptr);
  for (std::size_t track = 0; track < 2; ++track)
    for (std::size_t i = 0; i < 46; ++i)
      EXPECT_NEAR(o.tracks[track].tension[i], pull(track, i), kRound) << track << " " << i;
}

TEST_F(ObserverValues, SlipComparesTheHullAtEachTrackWithItsOwnSprocket) {
  const double heading = 0.7, pitch = 0.2, roll = -0.1;
  place({{5, -3, 2}, attitude(heading, pitch, roll)});
  // In the vehicle's own axes: 0.9 m/s forward, a drift to the left, a rise; and rotation about all three.
  const Vec3d v_V{0.9, 0.25, -0.1}, w_V{0.05, 0.11, 0.3};
  const Quat R = attitude(heading, pitch, roll);
  state.twist[v.chassis].v = base::rotate(R, v_V), state.twist[v.chassis].w = base::rotate(R, w_V);
  state.joint[left.sprocketJoint].rate = 2.5, state.joint[right.sprocketJoint].rate = -5;
  const auto o = Observer(v).observe(state, {}, nullptr);
  // The sprockets' axle passes through the frame's origin: at a track it moves forward by v + w x r, r from centre of
  // mass to (0, +-offset, 0).
  const Vec3d c = v.spec.chassis.centre;
  const double y = v.spec.trackOffset;
  ASSERT_GT(y, 0.5);
  const double atLeft = 0.9 + 0.11 * -c.z - 0.3 * (y - c.y), atRight = 0.9 + 0.11 * -c.z - 0.3 * (-y - c.y);
  EXPECT_NEAR(o.tracks[0].speed, atLeft, 1e-14);
  EXPECT_NEAR(o.tracks[1].speed, atRight, 1e-14);
  EXPECT_NEAR(o.tracks[0].slip, 1 - atLeft / (2.5 * kPitchRadius), 1e-13);
  EXPECT_NEAR(o.tracks[1].slip, 1 + atRight / (5 * kPitchRadius), 1e-13) << "it turns backwards, the hull moves on";
  EXPECT_EQ(o.tracks[0].sprocketSpeed, 2.5);
  EXPECT_EQ(o.tracks[1].sprocketSpeed, -5);
  const Vec3d velocity = base::rotate(R, v_V);
  for (int a = 0; a < 3; ++a) EXPECT_EQ(o.velocity[a], velocity[a]);
}

TEST_F(ObserverValues, AttitudeIsHeadingNoseUpAndRightSideDown) {
  for (const auto& [heading, pitch, roll] : {std::array{0.7, 0.2, -0.1}, {-2.9, -0.35, 0.25}, {1.6, 0.05, 0.6}}) {
    state = multibody::makeState(v.model);
    place({{5, -3, 2}, attitude(heading, pitch, roll)});
    const auto o = Observer(v).observe(state, {}, nullptr);
    EXPECT_NEAR(o.heading, heading, 1e-14);
    EXPECT_NEAR(o.pitchAngle, pitch, 1e-14);
    EXPECT_NEAR(o.rollAngle, roll, 1e-14);
    EXPECT_NEAR(norm(o.position - Vec3d{5, -3, 2}), 0, 1e-14);
  }
}

TEST_F(ObserverValues, MotionResistanceIsTractionLessTheDrawbarPull) {
  const double heading = 0.6, c = base::cos(heading), s = base::sin(heading);
  place({{}, attitude(heading, 0, 0)});
  state.joint[left.sprocketJoint].driveForce = 300, state.joint[right.sprocketJoint].driveForce = 500;
  state.joint[left.sprocketJoint].springForce = 7, state.joint[left.sprocketJoint].axisForce = 11;
  GroundLoads ground = noLoads();
  // Forward 1000 N by two shoes and a wheel of the right track, to the left 200 N, up 40 kN.
  ground.force[left.shoes[12]] = Vec3d{c, s, 0} * 700.0 + Vec3d{0, 0, 25000};
  ground.force[right.shoes[13]] = Vec3d{c, s, 0} * 400.0 + Vec3d{-s, c, 0} * 200.0 + Vec3d{0, 0, 15000};
  ground.force[right.wheels[1]] = Vec3d{c, s, 0} * -100.0;
  const auto o = Observer(v).observe(state, ground, nullptr);
  EXPECT_EQ(o.tracks[0].driveTorque, 300);
  EXPECT_EQ(o.tracks[1].driveTorque, 500);
  EXPECT_NEAR(o.groundForce.x, 1000, kRound);
  EXPECT_NEAR(o.groundForce.y, 200, kRound);
  EXPECT_NEAR(o.groundForce.z, 40000, kRound);
  EXPECT_NEAR(o.grossTraction, 800 / kPitchRadius, kRound);
  EXPECT_NEAR(o.drawbarPull, 1000, kRound);
  EXPECT_NEAR(o.motionResistance, 800 / kPitchRadius - 1000, kRound);
}

TEST_F(ObserverValues, IdlersAreReadByTrack) {
  state.joint[left.slideJoint].springForce = 9000, state.joint[right.slideJoint].springForce = 11000;
  state.joint[left.slideJoint].axisForce = 1, state.joint[left.slideJoint].driveForce = 2;
  state.joint[left.slideJoint].position = 0.003, state.joint[right.slideJoint].position = -0.005;
  state.joint[left.slideJoint].rate = 0.7;
  const auto o = Observer(v).observe(state, {}, nullptr);
  EXPECT_EQ(o.tracks[0].idlerForce, 9000);
  EXPECT_EQ(o.tracks[1].idlerForce, 11000);
  EXPECT_EQ(o.tracks[0].idlerSlide, 0.003);
  EXPECT_EQ(o.tracks[1].idlerSlide, -0.005);
}

TEST_F(ObserverValues, GroundPressureIsTheForceAlongThePadsNormalOverItsArea) {
  const double pitch = 0.3; // nose up: the pad's upward normal points backwards
  place({{}, attitude(0, pitch, 0)});
  GroundLoads ground = noLoads();
  const int first = test::firstGroundShoe(v.wrap);
  for (int k = 0; k < 3; ++k) {
    ground.force[left.shoes[first + k]] = {100.0 * k, 35, 2000.0 + 500 * k};
    ground.force[right.shoes[first + k]] = {-50, 0, 1000.0 * k};
  }
  const auto o = Observer(v).observe(state, ground, nullptr);
  // Pads extend +-68 mm along the track and +-140 mm across.
  const double area = 0.136 * 0.28, s = base::sin(pitch), c = base::cos(pitch);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(o.tracks[0].groundPressure[first + k], (-s * 100 * k + c * (2000.0 + 500 * k)) / area, 1e-9);
    EXPECT_NEAR(o.tracks[1].groundPressure[first + k], (s * 50 + c * 1000 * k) / area, 1e-9);
  }
  EXPECT_EQ(o.tracks[0].groundPressure[0], 0);
  // 5 t on 24 shoes are 2 kN each; a shoe counts as loaded above a hundredth of that.
  EXPECT_EQ(o.tracks[0].onGround[first + 2], 1);
  EXPECT_EQ(o.tracks[1].onGround[first], 0);
  EXPECT_EQ(o.tracks[1].onGround[first + 1], 1);
}

TEST_F(ObserverValues, ForcesOnAShoeAreInItsOwnAxes) {
  const double pitch = 0.3;
  place({{}, attitude(0, pitch, 0)});
  GroundLoads ground = noLoads();
  const int shoe = test::firstGroundShoe(v.wrap);
  ground.force[left.shoes[shoe]] = {300, 40, 2000};
  const auto o = Observer(v).observe(state, ground, nullptr).tracks[0];
  const double area = 0.136 * 0.28, s = base::sin(pitch), c = base::cos(pitch);
  EXPECT_NEAR(o.normalForce[shoe], -s * 300 + c * 2000, kRound);
  EXPECT_NEAR(o.forwardForce[shoe], c * 300 + s * 2000, kRound);
  EXPECT_NEAR(o.leftForce[shoe], 40, kRound);
  EXPECT_NEAR(o.shear[shoe], std::sqrt((c * 300 + s * 2000) * (c * 300 + s * 2000) + 1600) / area, 1e-9);
  EXPECT_EQ(o.normalForce[0], 0);
  EXPECT_TRUE(std::isnan(Observer(v).observe(state, {}, nullptr).tracks[0].shear[shoe])) << "no loads yet";
}

TEST_F(ObserverValues, TorqueAndPowerAreMeansSinceTheyWereBegun) {
  Observer observer(v);
  const auto turn = [&](double torque, double rate) {
    state.joint[left.sprocketJoint].driveForce = torque, state.joint[left.sprocketJoint].rate = rate;
    state.joint[right.sprocketJoint].driveForce = -2 * torque, state.joint[right.sprocketJoint].rate = 0.5 * rate;
  };
  turn(100, 3);
  const auto still = observer.observe(state, {}, nullptr);
  EXPECT_EQ(still.tracks[0].meanTorque, 100) << "before the first step: the torque of the state";
  EXPECT_EQ(still.tracks[0].drivePower, 300);
  observer.update(state, 0.01);
  turn(400, 2), observer.update(state, 0.01);
  const auto o = observer.observe(state, {}, nullptr);
  EXPECT_EQ(o.tracks[0].driveTorque, 400);
  EXPECT_EQ(o.tracks[0].meanTorque, 250);
  EXPECT_EQ(o.tracks[0].drivePower, 550);
  EXPECT_EQ(o.tracks[1].meanTorque, -500);
  EXPECT_EQ(o.tracks[1].drivePower, -550);
  EXPECT_NEAR(o.grossTraction, -250 / kPitchRadius, kRound);
  Observer resumed(v);
  resumed.restore(observer.save());
  EXPECT_EQ(resumed.observe(state, {}, nullptr).tracks[1].drivePower, -550);
  observer.restartMeans();
  observer.update(state, 0.01);
  EXPECT_EQ(observer.observe(state, {}, nullptr).tracks[0].meanTorque, 400);
}

TEST_F(ObserverValues, ArmsAreReadWheelByWheel) {
  for (std::size_t i = 0; i < 5; ++i) state.joint[left.armJoints[i]].position = 0.01 * static_cast<double>(i + 1);
  state.joint[right.armJoints[4]].position = -0.07;
  const auto o = Observer(v).observe(state, {}, nullptr);
  ASSERT_EQ(o.tracks[0].armAngle.size(), 5u);
  EXPECT_EQ(o.tracks[0].armAngle[3], 0.04);
  EXPECT_EQ(o.tracks[1].armAngle[4], -0.07);
}

TEST_F(ObserverValues, CarryingLoadIsAHundredthOfTheWeightOverBothGroundRuns) {
  EXPECT_NEAR(vehicle::carryingLoad(v, 9.80665), 0.01 * v.mass * 9.80665 / 24, 1e-12);
  const double half = 0.99 * vehicle::carryingLoad(v, 9.80665), more = 1.01 * vehicle::carryingLoad(v, 9.80665);
  GroundLoads ground = noLoads();
  const int shoe = test::firstGroundShoe(v.wrap);
  ground.force[left.shoes[shoe]].z = half, ground.force[right.shoes[shoe]].z = more;
  const auto o = Observer(v).observe(state, ground, nullptr);
  EXPECT_EQ(o.tracks[0].onGround[shoe], 0);
  EXPECT_EQ(o.tracks[1].onGround[shoe], 1);
}

/// The run's gravity sets the load threshold by its magnitude, and the load-bearing component by its direction.
TEST_F(ObserverValues, CarryingIsAgainstTheGravityOfTheRun) {
  GroundLoads ground = noLoads();
  const int shoe = test::firstGroundShoe(v.wrap);
  const auto carries = [&](const Vec3d& gravity, const Vec3d& force) {
    ground.force[left.shoes[shoe]] = force;
    return Observer(v, {.gravity = gravity}).observe(state, ground, nullptr).tracks[0].onGround[shoe];
  };
  const double share = 0.01 * v.mass / 24; // gravity 1 m/s2
  EXPECT_EQ(carries({0, 0, -1.62}, {0, 0, 1.65 * share}), 1);
  EXPECT_EQ(carries({0, 0, -1.62}, {0, 0, 1.6 * share}), 0);
  EXPECT_EQ(carries({-6, 0, -8}, {6.1 * share, 0, 8.1 * share}), 1) << "along gravity 10.1 of 10";
  EXPECT_EQ(carries({-6, 0, -8}, {0, 0, 12 * share}), 0) << "along gravity 9.6 of 10";
  EXPECT_EQ(carries({}, {0, 0, 1e-3}), 1) << "no weight: any force upward";
  EXPECT_EQ(carries({}, {}), 0);
}

TEST_F(ObserverValues, HeightsShiftsAndLiftsBelongToTheirTrack) {
  const auto before = Observer(v).observe(state, {}, nullptr);
  state.pose[left.shoes[20]].position.y += 0.007, state.pose[left.shoes[21]].position.y -= 0.004;
  state.pose[right.shoes[30]].position.y -= 0.013;
  state.pose[left.wheels[1]].position.z += 0.011, state.pose[left.wheels[2]].position.z += 0.006;
  state.pose[right.wheels[3]].position.z += 0.019;
  for (int i = 0; i < 46; ++i) {
    state.pose[left.shoes[i]].position.z += 0.001 * i;
    state.pose[right.shoes[i]].position.z -= 0.002 * i;
  }
  const auto o = Observer(v).observe(state, {}, nullptr);
  EXPECT_NEAR(o.tracks[0].sideways, 0.007, 1e-14);
  EXPECT_NEAR(o.tracks[1].sideways, 0.013, 1e-14);
  for (std::size_t i = 0; i < 46; ++i) {
    EXPECT_NEAR(o.tracks[0].padHeight[i] - before.tracks[0].padHeight[i], 0.001 * static_cast<double>(i), 1e-14);
    EXPECT_NEAR(o.tracks[1].padHeight[i] - before.tracks[1].padHeight[i], -0.002 * static_cast<double>(i), 1e-14);
  }
  // In the order of the wrap: the ground contact is lowest, 40 mm below its pins.
  const auto ground = static_cast<std::size_t>(test::firstGroundShoe(v.wrap));
  EXPECT_NEAR(before.tracks[0].padHeight[ground], v.spec.groundPinHeight() - 0.040, 1e-14);
  EXPECT_GT(before.tracks[0].padHeight[(ground + 23) % 46], v.spec.groundPinHeight() + 0.2);
}

TEST_F(ObserverValues, WheelLiftIsThatOfTheWheelFarthestOffItsPlates) {
  state.pose[left.wheels[1]].position.z += 0.011, state.pose[left.wheels[2]].position.z += 0.006;
  state.pose[right.wheels[3]].position.z += 0.019;
  const auto o = Observer(v).observe(state, {}, nullptr);
  EXPECT_NEAR(o.tracks[0].wheelLift, 0.011, 1e-14);
  EXPECT_NEAR(o.tracks[1].wheelLift, 0.019, 1e-14);
}

TEST_F(ObserverValues, ToothMeansSpanWholeTeethOfTheirOwnTrack) {
  vehicle::ObserverOptions options;
  options.averageTeeth = 2;
  Observer observer(v, options);
  const double dt = 0.01, y = v.spec.trackOffset - v.spec.chassis.centre.y;
  observer.update(state, dt);
  double wayLeft = 0, wayRight = 0;
  for (int k = 1; k <= 200; ++k) {
    state.time = dt * k;
    // The hull turns while driving: the left track is slower than the right one, and both accelerate.
    const double v0 = 0.4 + 0.001 * k, w = 0.2;
    state.twist[v.chassis].v = {v0, 0, 0}, state.twist[v.chassis].w = {0, 0, w};
    wayLeft += (v0 - w * y) * dt, wayRight += (v0 + w * (v.spec.trackOffset + v.spec.chassis.centre.y)) * dt;
    // 4 and 2 teeth a second, so that tooth boundaries fall on steps.
    state.joint[left.sprocketJoint].position = 4 * state.time * 2 * base::kPi / 10;
    state.joint[right.sprocketJoint].position = 2 * state.time * 2 * base::kPi / 10;
    observer.update(state, dt);
  }
  const auto o = observer.observe(state, {}, nullptr);
  // Speed at the track averaged over the last 0.5 s and 1 s: steps 151 to 200 and 101 to 200.
  EXPECT_NEAR(o.tracks[0].toothSpeed, 0.4 + 0.001 * 175.5 - 0.2 * y, 1e-9);
  EXPECT_NEAR(o.tracks[1].toothSpeed, 0.4 + 0.001 * 150.5 + 0.2 * (v.spec.trackOffset + v.spec.chassis.centre.y), 1e-9);
  EXPECT_NEAR(o.tracks[0].toothSlip, 1 - o.tracks[0].toothSpeed / (4 * 0.154), 1e-9);
  EXPECT_NEAR(o.tracks[1].toothSlip, 1 - o.tracks[1].toothSpeed / (2 * 0.154), 1e-9);
  EXPECT_NEAR(o.tracks[0].teethPassed, 8, 1e-12);
  EXPECT_NEAR(o.tracks[1].teethPassed, 4, 1e-12);
  EXPECT_NEAR(o.tracks[0].skipped, 8, 1e-12) << "no shoe has moved";
  EXPECT_EQ(o.tracks[0].pitchesPassed, 0);
  EXPECT_NEAR(observer.travel(0).distance(), wayLeft, 1e-12);
  EXPECT_NEAR(observer.travel(1).distance(), wayRight, 1e-12);
}

TEST_F(ObserverValues, TableWritesEachQuantityUnderItsOwnName) {
  vehicle::Observation o;
  double next = 1;
  const auto vec = [&](Vec3d& p) { p = {next, next + 1, next + 2}, next += 3; };
  vec(o.position), vec(o.velocity), vec(o.groundForce);
  std::map<std::string, std::vector<double>> expected = {
      {"position", {1, 2, 3}}, {"velocity", {4, 5, 6}}, {"ground_force", {7, 8, 9}}};
  const auto number = [&](const std::string& name, double& value) { expected[name] = {value = next}, ++next; };
  number("heading", o.heading), number("pitch_angle", o.pitchAngle), number("roll_angle", o.rollAngle);
  number("gross_traction", o.grossTraction), number("drawbar_pull", o.drawbarPull), number("net_thrust", o.netThrust);
  number("motion_resistance", o.motionResistance);
  for (const std::string side : {"left/", "right/"}) {
    vehicle::TrackObservation t;
    number(side + "sprocket_speed", t.sprocketSpeed), number(side + "drive_torque", t.driveTorque);
    number(side + "mean_torque", t.meanTorque), number(side + "drive_power", t.drivePower);
    number(side + "idler_force", t.idlerForce), number(side + "idler_slide", t.idlerSlide);
    number(side + "speed", t.speed), number(side + "slip", t.slip), number(side + "tooth_speed", t.toothSpeed);
    number(side + "tooth_slip", t.toothSlip), number(side + "teeth_passed", t.teethPassed);
    number(side + "pitches_passed", t.pitchesPassed), number(side + "skipped", t.skipped);
    number(side + "sideways", t.sideways), number(side + "wheel_lift", t.wheelLift);
    const auto shoes = [&](const std::string& name, std::vector<double>& values) {
      for (int i = 0; i < (name == "arm_angle" ? 5 : 46); ++i) values.push_back(next++);
      expected[side + name] = values;
    };
    shoes("arm_angle", t.armAngle), shoes("normal_force", t.normalForce), shoes("forward_force", t.forwardForce);
    shoes("left_force", t.leftForce), shoes("shear", t.shear);
    shoes("pad_height", t.padHeight), shoes("sinkage", t.sinkage), shoes("tension", t.tension);
    shoes("pin_lateral_force", t.pinLateral), shoes("pin_moment", t.pinMoment);
    shoes("ground_pressure", t.groundPressure), shoes("on_ground", t.onGround);
    o.tracks.push_back(t);
  }
  const std::vector<double> flat = vehicle::flatten(o, true);
  std::size_t at = 0;
  for (const vehicle::Quantity& q : vehicle::quantities(v, true)) {
    ASSERT_EQ(q.path.rfind("vehicle/", 0), 0u) << q.path;
    const auto found = expected.find(q.path.substr(8));
    if (found == expected.end()) { // an unknown column, with its width
      at += static_cast<std::size_t>(q.width);
      continue;
    }
    for (const double value : found->second) EXPECT_EQ(flat.at(at++), value) << q.path;
    expected.erase(found);
  }
  EXPECT_EQ(at, flat.size());
  for (const auto& [path, values] : expected) ADD_FAILURE() << path << " is not a column";
}

} // namespace

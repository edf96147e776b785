// SPDX-License-Identifier: BSD-3-Clause
// Angles counted beyond full turns, and forces in the direction of motion along the ground. The
// expected numbers follow from the prescribed attitude and forces.
#include "vehicle/observers.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "tests/vehicle/attitude.hpp"
#include "tests/vehicle/ground_shoes.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace grouser;
using base::Quat;
using base::Vec3d;
using vehicle::GroundLoads;
using vehicle::Observer;
using vehicle::testing::about;

namespace {

using grouser::vehicle::testing::kDegree;

class AlongGround : public ::testing::Test {
protected:
  vehicle::Assembly v =
      vehicle::assemble(vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  multibody::State start = multibody::makeState(v.model), state = start;
  const vehicle::Track &left = v.tracks[0], &right = v.tracks[1];
  const double pitchRadius = v.spec.pitchRadius();
  const double weight = v.mass * 9.81;
  /// Round-off of a few operations on forces up to 1e5 N.
  static constexpr double kRound = 1e-9;

  void place(const Quat& attitude, const Vec3d& at = {}) {
    for (std::size_t i = 0; i < state.pose.size(); ++i)
      state.pose[i] = multibody::compose({at, attitude}, start.pose[i]);
  }
  void drive(double leftRate, double rightRate, double leftTorque, double rightTorque) {
    state.joint[left.sprocketJoint].rate = leftRate, state.joint[right.sprocketJoint].rate = rightRate;
    state.joint[left.sprocketJoint].driveForce = leftTorque, state.joint[right.sprocketJoint].driveForce = rightTorque;
  }
  GroundLoads loads(const Vec3d& sum) const {
    GroundLoads ground;
    ground.force.resize(v.model.bodies().size());
    ground.force[left.shoes[test::firstGroundShoe(v.wrap)]] = sum * 0.25;
    ground.force[right.shoes[test::firstGroundShoe(v.wrap) + 2]] = sum * 0.75;
    return ground;
  }
};

/// 2.5 turns to the left and back in steps of 0.1 rad: every row's heading is the total rotation.
TEST_F(AlongGround, HeadingCountsOnBeyondHalfATurn) {
  Observer observer(v, {.heading = 178 * kDegree});
  const auto turnTo = [&](double heading) {
    place(about(2, heading));
    observer.update(state, 1e-3);
    return observer.observe(state, {}, nullptr).heading;
  };
  const double from = 178 * kDegree;
  for (int k = 0; k <= 157; ++k) ASSERT_NEAR(turnTo(from + 0.1 * k), from + 0.1 * k, 1e-13) << k;
  for (int k = 157; k >= -157; --k) ASSERT_NEAR(turnTo(from + 0.1 * k), from + 0.1 * k, 1e-13) << k;
}

TEST_F(AlongGround, HeadingBeginsAsTheSceneSays) {
  for (const double heading : {270.0, 180.0, -180.0, -200.0, 360.0}) {
    place(about(2, heading * kDegree));
    EXPECT_NEAR(Observer(v, {.heading = heading * kDegree}).observe(state, {}, nullptr).heading, heading * kDegree,
                1e-13);
  }
}

TEST_F(AlongGround, ACheckpointKnowsTheTurns) {
  Observer observer(v);
  for (int k = 0; k <= 80; ++k) place(about(2, 0.1 * k) * about(0, -0.05 * k)), observer.update(state, 1e-3);
  Observer resumed(v);
  resumed.restore(observer.save());
  EXPECT_NEAR(resumed.observe(state, {}, nullptr).heading, 8, 1e-13);
  EXPECT_NEAR(resumed.observe(state, {}, nullptr).rollAngle, -4, 1e-13);
  EXPECT_EQ(resumed.save(), observer.save());
}

/// A vehicle that rolls over to its right and further; nose-up angles are between straight down and straight up.
TEST_F(AlongGround, RollCountsOnWhereAVehicleRollsOver) {
  Observer observer(v);
  for (int k = 0; k <= 70; ++k) {
    place(about(2, 0.4) * about(0, 0.1 * k));
    observer.update(state, 1e-3);
    const auto o = observer.observe(state, {}, nullptr);
    ASSERT_NEAR(o.rollAngle, 0.1 * k, 1e-13);
    ASSERT_NEAR(o.heading, 0.4, 1e-13);
  }
}

/// In reverse, all signs change except the sign of the resistance.
TEST_F(AlongGround, InReverseForcesAreStatedBackward) {
  const Quat attitude = about(2, 0.6);
  place(attitude);
  drive(-2, -2, -300, -500);
  const auto o = Observer(v).observe(state, loads(base::rotate(attitude, {-1000, 200, weight})), nullptr);
  EXPECT_NEAR(o.groundForce.x, -1000, kRound) << "along the heading";
  EXPECT_NEAR(o.grossTraction, 800 / pitchRadius, kRound);
  EXPECT_NEAR(o.netThrust, 1000, kRound);
  EXPECT_NEAR(o.drawbarPull, 1000, kRound);
  EXPECT_NEAR(o.motionResistance, 800 / pitchRadius - 1000, kRound);
  EXPECT_EQ(o.tracks[0].meanTorque, -300) << "sprocket torque, forward positive";
}

/// The tracks brake a vehicle moving forward: motion resistance is still positive.
TEST_F(AlongGround, BrakingForcesAreNegativeAndResistanceIsNot) {
  drive(2, 2, -300, -300);
  for (multibody::Twist& twist : state.twist) twist.v = {1, 0, 0};
  const auto o = Observer(v).observe(state, loads({-900 / pitchRadius, 0, weight}), nullptr);
  EXPECT_LT(o.tracks[0].slip, 0);
  EXPECT_NEAR(o.grossTraction, -600 / pitchRadius, kRound);
  EXPECT_NEAR(o.motionResistance, 300 / pitchRadius, kRound);
}

/// Locked tracks: the hull's motion counts. Not for running tracks: a vehicle drawn back has slip above 1.
TEST_F(AlongGround, LockedTracksSlideWhereTheHullGoes) {
  drive(0, 0, 400, 400);
  for (multibody::Twist& twist : state.twist) twist.v = {-0.5, 0, 0};
  const GroundLoads ground = loads({5000, 0, weight});
  EXPECT_NEAR(Observer(v).observe(state, ground, nullptr).netThrust, -5000, kRound);
  drive(1, 1, 400, 400);
  const auto o = Observer(v).observe(state, ground, nullptr);
  EXPECT_NEAR(o.netThrust, 5000, kRound);
  EXPECT_GT(o.tracks[0].slip, 1);
}

TEST_F(AlongGround, WhereTracksRunAgainstEachOtherNothingResistsAlongTheHeading) {
  drive(-2, 2, -4000, 4500);
  const auto o = Observer(v).observe(state, loads({120, 0, weight}), nullptr);
  EXPECT_TRUE(std::isnan(o.motionResistance));
  EXPECT_NEAR(o.grossTraction, 500 / pitchRadius, kRound) << "forward along the heading";
  EXPECT_NEAR(o.netThrust, 120, kRound);
  drive(0, 2, 0, 4500);
  EXPECT_FALSE(std::isnan(Observer(v).observe(state, loads({120, 0, weight}), nullptr).motionResistance))
      << "about a locked track";
}

/// The direction is that of the mean motion since the last row, like torque and forces; a checkpoint stores it.
TEST_F(AlongGround, DirectionIsOfTheMeanSinceTheLastRow) {
  Observer observer(v);
  drive(-3, -3, -300, -300), observer.update(state, 1e-3);
  drive(1, 1, -100, -100), observer.update(state, 1e-3);
  Observer resumed(v);
  resumed.restore(observer.save());
  for (const Observer* each : {&observer, &resumed})
    EXPECT_NEAR(each->observe(state, {}, nullptr).grossTraction, 400 / pitchRadius, kRound);
  observer.restartMeans(), observer.update(state, 1e-3);
  EXPECT_NEAR(observer.observe(state, {}, nullptr).grossTraction, -200 / pitchRadius, kRound);
}

/// A stalled vehicle rocks back: the sign of the forces is kept until the tracks run back permanently.
TEST_F(AlongGround, AStalledVehicleThatRocksKeepsItsDirection) {
  Observer observer(v);
  const GroundLoads ground = loads({5000, 0, weight});
  const auto thrustAt = [&](Observer& watching, double speed) { // row of one step at `speed` [m/s]
    drive(speed / pitchRadius, speed / pitchRadius, 400, 400);
    watching.update(state, 1e-3);
    const double thrust = watching.observe(state, ground, nullptr).netThrust;
    watching.restartMeans();
    return thrust;
  };
  EXPECT_NEAR(thrustAt(observer, -0.001), -5000, kRound) << "the first motion sets the direction";
  EXPECT_NEAR(thrustAt(observer, 0.5), 5000, kRound);
  for (const double rocks : {-0.009, 0.002, -0.002, 0.0, -0.009})
    EXPECT_NEAR(thrustAt(observer, rocks), 5000, kRound) << rocks;
  EXPECT_NEAR(thrustAt(observer, -0.011), -5000, kRound);
  EXPECT_NEAR(thrustAt(observer, 0.009), -5000, kRound);
  Observer resumed(v);
  resumed.restore(observer.save());
  EXPECT_NEAR(thrustAt(resumed, 0.009), -5000, kRound) << "a checkpoint stores the direction";
  EXPECT_NEAR(thrustAt(resumed, 0.011), 5000, kRound);
}

TEST_F(AlongGround, CheckpointsOfAnotherLayoutAreRefusedWithTheRemedy) {
  std::vector<double> saved = Observer(v).save();
  saved.resize(saved.size() -
               7); // two tracks' rates and speeds, heading, roll and direction: format of earlier versions
  Observer observer(v);
  try {
    observer.restore(saved);
    FAIL() << "was accepted";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--force"), std::string::npos) << error.what();
  }
}

/// The same climb on inclined ground and on level ground under an inclined gravity: all forces rotate with the ground.
TEST_F(AlongGround, AGradeIsTheSameHoweverItIsBuilt) {
  const double heading = 0.8, c = base::cos(heading), s = base::sin(heading), rest = 949; // [N]
  for (const double grade : {10.0, -10.0, 30.0})
    for (const int way : {1, -1}) {
      const double slope = base::sin(grade * kDegree) / base::cos(grade * kDegree);
      const double climb = way * weight * base::sin(grade * kDegree);
      drive(2 * way, 2 * way, way * 0.5 * (climb + rest) * pitchRadius, way * 0.5 * (climb + rest) * pitchRadius);
      const Vec3d along{way * climb, 0, weight * base::cos(grade * kDegree)}; // in the vehicle's axes
      const Quat level = about(2, heading), risen = level * about(1, -grade * kDegree);
      place(level);
      const auto leaning =
          Observer(v).observe(state, loads(base::rotate(level, along)), [](double, double) { return -0.44; });
      place(risen);
      const auto ramp = Observer(v).observe(state, loads(base::rotate(risen, along)),
                                            [&](double x, double y) { return slope * (x * c + y * s) - 0.44; });
      for (const auto& o : {leaning, ramp}) {
        EXPECT_NEAR(o.netThrust, climb, 1e-8) << grade << " " << way;
        EXPECT_NEAR(o.motionResistance, rest, 1e-8) << grade << " " << way;
      }
      EXPECT_NEAR(ramp.groundForce.x, 0, 1e-8) << "level, along the heading: the weight has no such component";
    }
}

/// Across a slope the ground does not rise along the heading, and the vehicle slides to its left.
TEST_F(AlongGround, ASideSlopeHasNoClimb) {
  const Quat tilted = about(0, 20 * kDegree); // left side up
  place(tilted);
  drive(2, 2, 500, 500);
  const double tangent = base::sin(20 * kDegree) / base::cos(20 * kDegree);
  const auto o = Observer(v).observe(state, loads({700, 0, weight}), [&](double, double y) { return tangent * y; });
  EXPECT_NEAR(o.netThrust, 700, 1e-9);
}

/// A vehicle on the top of a round hill, and on its flanks: the rise is the mean over the ground contact,
/// for a parabola equal to that in its middle, by symmetry.
TEST_F(AlongGround, OnAHillTheGroundUnderTheVehicleCounts) {
  drive(2, 2, 500, 500);
  const double middle = v.spec.roadWheel.firstX + 0.5 * v.spec.groundRun();
  for (const double at : {0.0, 1.5, -3.0}) {
    place({1, 0, 0, 0}, {at - middle, 0, 0});
    const auto o = Observer(v).observe(state, loads({0, 0, weight}), [](double x, double) { return -0.04 * x * x; });
    const double rise = -0.08 * at;
    EXPECT_NEAR(o.netThrust, weight * rise / std::sqrt(1 + rise * rise), 1e-6) << at;
  }
}

} // namespace

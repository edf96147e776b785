// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/observation_table.hpp"
#include "vehicle/observers.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "tests/vehicle/ground_shoes.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace grouser;
using base::Vec3d;
using vehicle::Assembly;
using vehicle::GroundLoads;
using vehicle::Observer;

namespace {

/// A vehicle at its start; the test sets its state.
class Observers : public ::testing::Test {
protected:
  Assembly v = vehicle::assemble(vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  multibody::State state = multibody::makeState(v.model);
  const vehicle::Track& left = v.tracks[0];

  /// Every shoe moves to the place of the one `pitches` behind it in the wrap: the top run moves forward.
  void moveTrack(const vehicle::Track& track, int pitches) {
    const int n = static_cast<int>(track.shoes.size());
    const int from = ((-pitches) % n + n) % n;
    for (int i = 0; i < n; ++i) state.pose[track.shoes[i]] = v.model.bodies()[track.shoes[(i + from) % n]].pose;
  }
  void turnSprocket(const vehicle::Track& track, double teeth) {
    state.joint[track.sprocketJoint].position = teeth * 2 * base::kPi / 10;
  }
  /// The weight, evenly distributed over the shoes of both ground runs.
  GroundLoads standing() const {
    GroundLoads ground;
    ground.force.resize(v.model.bodies().size());
    for (const vehicle::Track& track : v.tracks)
      for (int i = test::firstGroundShoe(v.wrap); i <= test::lastGroundShoe(v.wrap); ++i)
        ground.force[track.shoes[i]].z = 5018 * 9.81 / 24;
    return ground;
  }
};

TEST_F(Observers, PadHeight_IsTheLowestCornerOfAPitchedShoe) {
  base::Pose pose{{1, 2, 3}, vehicle::planeRotation(0.1)};
  EXPECT_NEAR(vehicle::padHeight(v.spec.shoe, pose), 3 - 0.068 * base::sin(0.1) - 0.040 * base::cos(0.1), 1e-15);
}

TEST_F(Observers, GroundRun_IsTheTwelveShoesUnderTheWheels) {
  for (int i = 0; i < 46; ++i)
    EXPECT_EQ(vehicle::onGroundRun(v, 0, i, state),
              i >= test::firstGroundShoe(v.wrap) && i <= test::lastGroundShoe(v.wrap))
        << i;
}

TEST_F(Observers, Sinkage_IsSurfaceMinusPadWhereLoadIsCarried) {
  const Observer observer(v);
  GroundLoads ground = standing();
  const int idle = test::firstGroundShoe(v.wrap) + 3;
  ground.force[left.shoes[idle]].z = 0.5 * vehicle::carryingLoad(v, vehicle::kStandardGravity);
  const auto o = observer.observe(state, ground, [](double x, double) { return 0.01 * x - 0.4; });
  for (int i = 0; i < 46; ++i) {
    const bool carries = i >= test::firstGroundShoe(v.wrap) && i <= test::lastGroundShoe(v.wrap) && i != idle;
    EXPECT_EQ(o.tracks[0].onGround[i], carries ? 1 : 0);
    if (carries)
      EXPECT_NEAR(o.tracks[0].sinkage[i], (0.01 * v.wrap.shoeCentre(i).x - 0.4 + 0.44) / std::sqrt(1 + 0.01 * 0.01),
                  1e-13);
    else
      EXPECT_TRUE(std::isnan(o.tracks[0].sinkage[i]));
  }
  EXPECT_NEAR(o.tracks[0].groundPressure[test::firstGroundShoe(v.wrap)], 5018 * 9.81 / 24 / (0.136 * 0.28), 1e-9);
  EXPECT_EQ(o.alarm.text, "");
}

TEST_F(Observers, WithoutGroundLoads_NothingIsClaimed) {
  const auto o = Observer(v).observe(state, {}, nullptr);
  EXPECT_TRUE(std::isnan(o.groundForce.z));
  EXPECT_TRUE(std::isnan(o.tracks[1].sinkage[test::firstGroundShoe(v.wrap)]));
  EXPECT_TRUE(std::isnan(o.tracks[1].groundPressure[0]));
  EXPECT_TRUE(std::isnan(o.tracks[1].slip));
}

TEST_F(Observers, GroundForce_IsTakenAlongTheHeading) {
  vehicle::AssemblyOptions options;
  options.pose_W = vehicle::placeOnGround(v.spec, 0, 0, 0, 0, 0.5 * base::kPi);
  const Assembly turned = vehicle::assemble(v.spec, options);
  GroundLoads ground;
  ground.force.resize(turned.model.bodies().size());
  ground.force[turned.tracks[0].shoes[7]] = {-30, 40, 50};
  const auto o = Observer(turned).observe(multibody::makeState(turned.model), ground, nullptr);
  EXPECT_NEAR(o.heading, 0.5 * base::kPi, 1e-15);
  EXPECT_NEAR(o.groundForce.x, 40, 1e-13);
  EXPECT_NEAR(o.groundForce.y, 30, 1e-13);
  EXPECT_NEAR(o.drawbarPull, 40, 1e-13);
}

TEST_F(Observers, TrackAndSprocketTogether_SkipNothing) {
  Observer observer(v);
  observer.update(state, 0.1);
  for (int k = 1; k <= 60; ++k) {
    moveTrack(left, k), turnSprocket(left, k);
    state.time += 0.1;
    observer.update(state, 0.1);
  }
  // A full loop is 46 pitches: 60 must not alias.
  EXPECT_NEAR(observer.travel(0).pitchesPassed(), 60, 1e-12);
  EXPECT_NEAR(observer.travel(0).skipped(), 0, 1e-12);
  EXPECT_EQ(observer.travel(1).pitchesPassed(), 0);
  EXPECT_EQ(observer.alarm(state, standing()).text, "");
}

TEST_F(Observers, TrackThatMissesATooth_RaisesTheSkipAlarm) {
  Observer observer(v);
  observer.update(state, 0.1);
  for (int k = 1; k <= 8; ++k) {
    moveTrack(left, k < 5 ? k : k - 1), turnSprocket(left, k);
    observer.update(state, 0.1);
  }
  EXPECT_NEAR(observer.travel(0).skipped(), 1, 1e-12);
  EXPECT_NE(observer.alarm(state, standing()).text.find("left track skips"), std::string::npos);
}

TEST_F(Observers, BackwardTrack_CountsBackward) {
  Observer observer(v);
  observer.update(state, 0.1);
  moveTrack(left, -3), turnSprocket(left, -3);
  observer.update(state, 0.1);
  EXPECT_NEAR(observer.travel(0).pitchesPassed(), -3, 1e-12);
}

TEST_F(Observers, ToothSlip_ComparesGroundCoveredWithWholePitches) {
  Observer observer(v);
  observer.update(state, 0.01);
  // 3.7 teeth/s at 0.5 m/s: 3.7 x 0.154 = 0.5698 m/s without slip.
  state.twist[v.chassis].v = {0.5, 0, 0};
  for (int k = 1; k <= 100; ++k) {
    state.time = 0.01 * k;
    turnSprocket(left, 0.037 * k);
    observer.update(state, 0.01);
  }
  EXPECT_NEAR(observer.travel(0).toothSpeed(), 0.5, 1e-12);
  EXPECT_NEAR(observer.travel(0).toothSlip(), 1 - 0.5 / (3.7 * 0.154), 1e-12);
  EXPECT_NEAR(observer.travel(0).distance(), 0.5, 1e-12);
}

TEST_F(Observers, ReversedSprocket_BeginsANewMean) {
  Observer observer(v);
  observer.update(state, 0.01);
  state.twist[v.chassis].v = {0.5, 0, 0};
  double teeth = 0;
  for (int k = 1; k <= 60; ++k) {
    state.time = 0.01 * k;
    turnSprocket(left, teeth += 0.037);
    observer.update(state, 0.01);
  }
  EXPECT_FALSE(std::isnan(observer.travel(0).toothSpeed()));
  state.twist[v.chassis].v = {-0.25, 0, 0};
  for (int k = 61; k <= 100; ++k) {
    state.time = 0.01 * k;
    turnSprocket(left, teeth -= 0.037);
    observer.update(state, 0.01);
    const double speed = observer.travel(0).toothSpeed();
    EXPECT_TRUE(std::isnan(speed) || std::fabs(speed - 0.5) < 1e-12 || std::fabs(speed + 0.25) < 1e-12)
        << k << " " << speed;
  }
  EXPECT_NEAR(observer.travel(0).toothSpeed(), -0.25, 1e-12);
}

TEST_F(Observers, RestoredObserver_GoesOnWithTheSameBits) {
  Observer straight(v), resumed(v);
  for (int k = 0; k <= 40; ++k) {
    state.time = 0.01 * k;
    state.twist[v.chassis].v = {0.4, 0, 0};
    moveTrack(left, k / 10), turnSprocket(left, 0.09 * k);
    straight.update(state, 0.01);
    if (k == 23) resumed.restore(straight.save());
    if (k > 23) resumed.update(state, 0.01);
  }
  EXPECT_EQ(straight.save(), resumed.save());
  EXPECT_THROW(resumed.restore({1, 2, 3}), base::InputError);
}

TEST_F(Observers, AtTheStart_WheelsTouchTheirPlates) {
  EXPECT_NEAR(vehicle::wheelLift(v, 0, state), 0, 1e-15);
  EXPECT_NEAR(vehicle::sidewaysShift(v, 0, state), 0, 1e-15);
}

TEST_F(Observers, WheelLiftedMoreThanAHorn_IsAThrownTrackOnlyBesideItsHornsAndStanding) {
  const Observer observer(v);
  state.pose[left.wheels[2]].position.z += 0.077;
  EXPECT_NEAR(vehicle::wheelLift(v, 0, state), 0.077, 1e-14);
  EXPECT_EQ(observer.alarm(state, standing()).text, "") << "in its plane";
  for (const int shoe : left.shoes) state.pose[shoe].position.y += 0.04;
  EXPECT_NE(observer.alarm(state, standing()).text.find("left track thrown"), std::string::npos);
  // A slack lower run sags by this much.
  EXPECT_EQ(observer.alarm(state, {}).text, "");
  state.pose[left.wheels[2]].position.z += 0.2;
  EXPECT_NE(observer.alarm(state, {}).text.find("left track thrown"), std::string::npos);
}

TEST_F(Observers, AWheelThatRollsOverAStone_IsNoThrownTrack) {
  state.pose[left.wheels[2]].position.z += 0.067; // the largest grain of 27 mm +- 25 %
  for (const int shoe : left.shoes) state.pose[shoe].position.y += 0.04;
  EXPECT_NE(Observer(v).alarm(state, standing()).text, "");
  const Observer onStones(v, {.stone = 0.0675});
  EXPECT_EQ(onStones.alarm(state, standing()).text, "");
  state.pose[left.wheels[2]].position.z += 0.062;
  EXPECT_NE(onStones.alarm(state, standing()).text.find("left road wheel 2 is 129 mm off its plates, more than 128 mm"),
            std::string::npos)
      << onStones.alarm(state, standing()).text;
}

TEST_F(Observers, SuspendedSag_CoversTheKnownOne) {
  // The plane model has 77 mm; the parabola over the whole span is above it, by no more than a factor of two.
  EXPECT_GT(vehicle::suspendedSag(v.spec, 9.81), 0.077);
  EXPECT_LT(vehicle::suspendedSag(v.spec, 9.81), 0.154);
}

TEST_F(Observers, ShoeBesideItsWheels_IsAThrownTrack) {
  const Observer observer(v);
  state.pose[v.tracks[1].shoes[20]].position.y -= 0.059;
  EXPECT_EQ(observer.alarm(state, standing()).text, "");
  state.pose[v.tracks[1].shoes[20]].position.y -= 0.002;
  EXPECT_NE(observer.alarm(state, standing()).text.find("right track thrown"), std::string::npos);
}

TEST_F(Observers, NanInTheState_RaisesTheAlarm) {
  state.pose[left.shoes[3]].position.y = std::nan("");
  EXPECT_NE(Observer(v).alarm(state, standing()).text, "");
}

TEST_F(Observers, Table_HasAsManyNumbersAsItNames) {
  const auto o = Observer(v).observe(state, standing(), nullptr);
  for (const bool forces : {false, true}) {
    std::size_t numbers = 0;
    std::set<std::string> paths;
    for (const vehicle::Quantity& q : vehicle::quantities(v, forces)) {
      numbers += q.width;
      EXPECT_TRUE(paths.insert(q.path).second) << q.path;
      EXPECT_TRUE(q.columns.empty() || static_cast<int>(q.columns.size()) == q.width);
    }
    EXPECT_EQ(vehicle::flatten(o, forces).size(), numbers);
    EXPECT_EQ(paths.count("vehicle/left/shear"), forces ? 1u : 0u);
  }
}

} // namespace

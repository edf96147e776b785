// SPDX-License-Identifier: BSD-3-Clause
// Detection of a thrown track; the message contains the part, the distance, and the remedy.
#include "vehicle/track_watch.hpp"

#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace grouser::vehicle {
namespace {

class TrackWatch : public ::testing::Test {
protected:
  const Assembly v = assemble(readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  multibody::State state = multibody::makeState(v.model);
  const double lift = v.spec.shoe.hornHeight;

  void move(int body, const base::Vec3d& by) { state.pose[static_cast<std::size_t>(body)].position += by; }
};

TEST_F(TrackWatch, AsItWasWrappedItRunsAroundAll) {
  for (const int track : {0, 1}) {
    EXPECT_EQ(outsideLoop(v, track, state), -1);
    EXPECT_EQ(thrownTrack(v, track, state, lift), "");
  }
}

TEST_F(TrackWatch, AShoeBesideItsWheelsIsNamedWithItsDistance) {
  move(v.tracks[1].shoes[20], {0, -0.0612, 0});
  EXPECT_EQ(maxLateralShift(v, 1, state).shoe, 20);
  EXPECT_EQ(thrownTrack(v, 0, state, lift), "");
  EXPECT_EQ(thrownTrack(v, 1, state, lift),
            "right track thrown: right shoe 20 is 61 mm beside its wheels, more than a horn's height of 60 mm; tighten "
            "the track (idler.preload of the vehicle file, 9200 N), turn and drive more gently (driver), or use a "
            "smaller time_step");
}

// Steps of 0.51 and 0.67 m: four wheels hung free over a strand 0.08 mm off its plane.
TEST_F(TrackWatch, ATrackThatHangsOffItsWheelsInItsPlaneIsGuided) {
  const Track& left = v.tracks[0];
  for (const int i : {1, 2, 3, 4}) move(left.wheels[static_cast<std::size_t>(i)], {0, 0, 0.062});
  for (const int shoe : left.shoes) move(shoe, {0, 0.0001, 0});
  EXPECT_NEAR(maxLifted(v, 0, state).gap, 0.062, 1e-12);
  EXPECT_EQ(unguidedWheel(v, 0, state, lift).body, -1);
  EXPECT_EQ(thrownTrack(v, 0, state, lift), "");
  for (const int i : {1, 2, 3, 4}) move(left.wheels[static_cast<std::size_t>(i)], {0, 0, 0.1});
  EXPECT_EQ(thrownTrack(v, 0, state, lift), "") << "at any distance";
}

TEST_F(TrackWatch, HornsThatAreOutOfAWheelAndBesideItAreNamedWithBoth) {
  const Track& left = v.tracks[0];
  move(left.wheels[3], {0, 0, 0.077});
  for (const int shoe : left.shoes) move(shoe, {0, -0.029, 0});
  EXPECT_EQ(thrownTrack(v, 0, state, lift), "") << "over the gap between the discs";
  for (const int shoe : left.shoes) move(shoe, {0, -0.003, 0});
  const std::string thrown = thrownTrack(v, 0, state, lift);
  EXPECT_EQ(thrown.rfind("left track thrown: left road wheel 3 is 77 mm off its plates, more than 60 mm, and 32 mm "
                         "beside their horns, more than half of their height of 60 mm; tighten",
                         0),
            0u)
      << thrown;
  EXPECT_EQ(thrownTrack(v, 0, state, 0.1), "") << "allowed sag";
  move(left.wheels[3], {0, 0, -0.077});
  EXPECT_EQ(thrownTrack(v, 0, state, lift), "") << "its horns are where the discs push them back";
}

TEST_F(TrackWatch, RollersGuideToo) {
  const Track& left = v.tracks[0];
  move(left.rollers[1], {0, 0, -0.07});
  EXPECT_EQ(thrownTrack(v, 0, state, lift), "");
  for (const int shoe : left.shoes) move(shoe, {0, 0.031, 0});
  const UnguidedWheel off = unguidedWheel(v, 0, state, lift);
  EXPECT_EQ(off.body, left.rollers[1]);
  EXPECT_NEAR(off.beside, 0.031, 1e-12);
  EXPECT_GT(off.gap, lift);
}

TEST_F(TrackWatch, ALoopThatHasLeftWhatItWasWrappedOnIsSeen) {
  const Track& left = v.tracks[0];
  for (const auto& [body, away, name] : {std::tuple{left.sprocket, base::Vec3d{-0.4, 0, 0}, "left sprocket"},
                                         {left.idler, {0.4, 0, 0}, "left idler"},
                                         {left.rollers[1], {0, 0, 0.15}, "left roller 1"}}) {
    state = multibody::makeState(v.model);
    move(body, away);
    EXPECT_EQ(outsideLoop(v, 0, state), body);
    const std::string thrown = thrownTrack(v, 0, state, lift);
    EXPECT_EQ(thrown.rfind(std::string("left track thrown: it no longer runs around ") + name + "; tighten", 0), 0u)
        << thrown;
  }
}

TEST_F(TrackWatch, APoseThatIsNoNumberIsThrown) {
  state.pose[static_cast<std::size_t>(v.tracks[0].shoes[3])].position.y = std::nan("");
  EXPECT_NE(thrownTrack(v, 0, state, lift), "");
}

} // namespace
} // namespace grouser::vehicle

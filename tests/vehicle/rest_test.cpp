// SPDX-License-Identifier: BSD-3-Clause
// A driver that waits until the vehicle rests.
#include "vehicle/driver.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

using namespace grouser;
using vehicle::Driver;

namespace {

/// Waits from 1 s for at most 2 s; 4 rad/s without a ramp.
Driver waiting() {
  return Driver({.tensionRamp = 0.25,
                 .weightRamp = 0.75,
                 .driveStart = 1,
                 .driveRamp = 0,
                 .rest = vehicle::RestBounds{.speed = 0.01, .load = 0.05, .timeLimit = 2},
                 .speeds = {{0, 1}, {4, 8}, {4, 8}}});
}

/// Checks every 10 ms from `from` to before `to`; returns the last result.
std::string judged(Driver& driver, int from, int to, double speed, double load) {
  std::string word;
  for (int k = from; k < to; ++k) word = driver.judge(0.01 * k, speed, load);
  return word;
}

} // namespace

TEST(Rest, Driver_WaitsWhileTheHullMoves) {
  Driver driver = waiting();
  EXPECT_EQ(judged(driver, 0, 150, 0.02, 1), "");
  EXPECT_EQ(judged(driver, 150, 200, -0.02, 1), "");
  EXPECT_FALSE(driver.driveStart().has_value());
  EXPECT_EQ(driver.at(1.99).sprocketSpeed[0], 0);
  EXPECT_EQ(driver.at(1.99).weight, 1);
}

TEST(Rest, Driver_WaitsWhileTheGroundDoesNotCarryTheWeight) {
  Driver driver = waiting();
  judged(driver, 0, 150, 0.001, 0.94);
  judged(driver, 150, 200, 0.001, 1.06);
  EXPECT_TRUE(driver.waits());
  judged(driver, 200, 210, -0.009, 0.951);
  EXPECT_FALSE(driver.waits());
}

TEST(Rest, Driver_BeginsOnceBothHaveHeldFor50Milliseconds) {
  Driver driver = waiting();
  judged(driver, 0, 110, 0.001, 1); // always at rest, but without its full weight before 1 s
  ASSERT_TRUE(driver.driveStart().has_value());
  EXPECT_NEAR(*driver.driveStart(), 1.05, 1e-12);
  EXPECT_EQ(driver.at(1.04).sprocketSpeed[0], 0);
  EXPECT_NEAR(driver.at(1.06).sprocketSpeed[0], 4.04, 1e-12);
  // The table's time starts with the drive.
  EXPECT_NEAR(driver.at(1.55).sprocketSpeed[1], 6, 1e-12);
}

TEST(Rest, Driver_ADisturbanceBeginsTheWaitAnew) {
  Driver driver = waiting();
  judged(driver, 100, 104, 0.001, 1);
  judged(driver, 104, 105, 0.02, 1);
  judged(driver, 105, 109, 0.001, 1);
  EXPECT_TRUE(driver.waits());
  judged(driver, 109, 111, 0.001, 1);
  EXPECT_FALSE(driver.waits());
}

TEST(Rest, Driver_AfterTheLimitSaysWhatIsNotAtRest) {
  Driver driver = waiting();
  EXPECT_EQ(judged(driver, 0, 301, 0.3, 0.7), "");
  const std::string message = judged(driver, 301, 302, 0.3, 0.7);
  for (const char* word : {"driver.rest_time_limit = 2 s", "0.3 m/s", "0.7 times the weight", "driver.drive_start"})
    EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(Rest, Driver_GoesOnFromWhatItSaved) {
  Driver driver = waiting();
  judged(driver, 100, 103, 0.001, 1);
  Driver other = waiting();
  other.restore(driver.save());
  judged(driver, 103, 106, 0.001, 1), judged(other, 103, 106, 0.001, 1);
  ASSERT_TRUE(driver.driveStart() && other.driveStart());
  EXPECT_EQ(*driver.driveStart(), *other.driveStart());
  Driver third = waiting();
  third.restore(driver.save());
  EXPECT_FALSE(third.waits());
  EXPECT_THROW(third.restore({}), base::InputError);
}

TEST(Rest, Driver_WithAStartOfItsOwnHasNothingToSave) {
  const Driver driver({.driveStart = 0.7});
  EXPECT_FALSE(driver.waits());
  EXPECT_EQ(driver.driveStart(), 0.7);
  EXPECT_TRUE(driver.save().empty());
}

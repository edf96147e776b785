// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/driver.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

using namespace grouser;
using vehicle::Controls;
using vehicle::Driver;

TEST(Driver, Stages_FollowOneAnother) {
  const Driver driver(
      {.tensionRamp = 0.25, .weightRamp = 0.5, .driveStart = 1, .driveRamp = 0.5, .speeds = {{0}, {2}, {4}}});
  const Controls start = driver.at(0), tensioned = driver.at(0.25), down = driver.at(0.75), full = driver.at(1.5);
  EXPECT_EQ(start.tension, 0);
  EXPECT_EQ(start.weight, 0);
  EXPECT_EQ(tensioned.tension, 1);
  EXPECT_EQ(tensioned.weight, 0);
  EXPECT_EQ(down.weight, 1);
  EXPECT_EQ(down.sprocketSpeed[0], 0);
  EXPECT_EQ(full.sprocketSpeed[0], 2);
  EXPECT_EQ(full.sprocketSpeed[1], 4);
  // The middle of a cubic ramp is exactly one half.
  EXPECT_EQ(driver.at(0.125).tension, 0.5);
  EXPECT_EQ(driver.at(1.25).sprocketSpeed[1], 2);
}

TEST(Driver, SmoothRamp_StartsAndEndsAtRest) {
  const double h = 1e-4;
  EXPECT_LT(vehicle::smoothRamp(h, 0, 1) / h, 3 * h + 1e-12);
  EXPECT_LT((1 - vehicle::smoothRamp(1 - h, 0, 1)) / h, 3 * h + 1e-8);
  EXPECT_EQ(vehicle::smoothRamp(0, 0, 0), 1);
}

TEST(Driver, SpeedTable_IsLinearBetweenAndConstantOutside) {
  const Driver driver({.tensionRamp = 0,
                       .weightRamp = 0,
                       .driveStart = 0,
                       .driveRamp = 0,
                       .speeds = {{1, 2, 4}, {1, 3, -1}, {0, 0, 8}}});
  EXPECT_EQ(driver.at(0.5).sprocketSpeed[0], 1);
  EXPECT_EQ(driver.at(1.5).sprocketSpeed[0], 2);
  EXPECT_EQ(driver.at(3).sprocketSpeed[0], 1);
  EXPECT_EQ(driver.at(3).sprocketSpeed[1], 4);
  EXPECT_EQ(driver.at(9).sprocketSpeed[1], 8);
}

TEST(Driver, TakenOverUnderWay_PassesFromTheFormerSpeeds) {
  const vehicle::DriverOptions options{.tensionRamp = 0,
                                       .weightRamp = 0,
                                       .driveStart = 0,
                                       .driveRamp = 0.25,
                                       .changeRamp = 0.5,
                                       .speeds = {{0, 4}, {0, 8}, {0, -8}}};
  Driver driver(options);
  driver.takeOver({}, {.driven = true, .time = 2, .sprocketSpeed = {6, 2}});
  EXPECT_EQ(driver.at(2).sprocketSpeed, (std::array{6.0, 2.0})) << "no jump";
  EXPECT_EQ(driver.at(2.25).sprocketSpeed, (std::array{0.5 * (6 + 4.5), 0.5 * (2 - 4.5)}));
  EXPECT_EQ(driver.at(3).sprocketSpeed, (std::array{6.0, -6.0})) << "times count from the start of the drive";
  EXPECT_EQ(driver.rampEnds(0), 2.5);
  Driver resumed(options);
  resumed.restore(driver.save());
  EXPECT_EQ(resumed.at(2.1).sprocketSpeed, driver.at(2.1).sprocketSpeed);
  EXPECT_THROW(Driver({.rest = vehicle::RestBounds{}}).takeOver({}, {}), base::InputError);
}

TEST(Driver, TakenOverBeforeTheDrive_IsAsFromTheStart) {
  const vehicle::DriverOptions options{.rest = vehicle::RestBounds{}, .speeds = {{0}, {2}, {2}}};
  Driver driver(options), same(options);
  driver.takeOver({0.5, 0.45}, {.driven = false, .time = 0.5, .sprocketSpeed = {1, 1}});
  same.restore({0.5, 0.45});
  EXPECT_EQ(driver.driveStart(), 0.5);
  EXPECT_EQ(driver.at(0.6).sprocketSpeed, same.at(0.6).sprocketSpeed);
  EXPECT_EQ(driver.save(), same.save());
}

TEST(Driver, BadOptions_AreRefused) {
  EXPECT_THROW(Driver({.speeds = {{1, 0}, {1, 1}, {1, 1}}}), base::InputError);
  EXPECT_THROW(Driver({.speeds = {{0, 1}, {1}, {1, 1}}}), base::InputError);
  EXPECT_THROW(Driver({.tensionRamp = -1}), base::InputError);
  EXPECT_THROW(Driver({.weightRamp = 2}), base::InputError);
}

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
  // Half of a cubic ramp is one half, exactly.
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

TEST(Driver, BadOptions_AreRefused) {
  EXPECT_THROW(Driver({.speeds = {{1, 0}, {1, 1}, {1, 1}}}), base::InputError);
  EXPECT_THROW(Driver({.speeds = {{0, 1}, {1}, {1, 1}}}), base::InputError);
  EXPECT_THROW(Driver({.tensionRamp = -1}), base::InputError);
  EXPECT_THROW(Driver({.weightRamp = 2}), base::InputError);
}

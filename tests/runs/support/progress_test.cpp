// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/progress.hpp"

#include <gtest/gtest.h>

namespace grouser::support {
namespace {

TEST(Progress, TimeLeftIsThatOfTheShareDone) {
  EXPECT_EQ(Progress::line("running", 0.25, 30, "t 1 s"), "running:  25.0 %, t 1 s, 1 min 30 s left");
  EXPECT_EQ(Progress::line("running", 0, 30, "t 0 s"), "running:   0.0 %, t 0 s, time left unknown yet");
}

TEST(Progress, DurationsReadWell) {
  EXPECT_EQ(Progress::duration(0.04), "0.0 s");
  EXPECT_EQ(Progress::duration(9.96), "10 s");
  EXPECT_EQ(Progress::duration(59.6), "1 min 00 s");
  EXPECT_EQ(Progress::duration(185), "3 min 05 s");
  EXPECT_EQ(Progress::duration(7800), "2 h 10 min");
}

TEST(Progress, NothingIsDueAtOnce) {
  const Progress progress("running");
  EXPECT_FALSE(progress.due());
}

} // namespace
} // namespace grouser::support

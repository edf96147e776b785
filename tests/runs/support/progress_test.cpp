// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/progress.hpp"

#include <gtest/gtest.h>

namespace grouser::support {
namespace {

TEST(Progress, LineTellsTheTimeLeft) {
  EXPECT_EQ(Progress::line("running", 0.25, 90, "t 1 s"), "running:  25.0 %, t 1 s, about 1 min 30 s left");
  EXPECT_EQ(Progress::line("running", 0, {}, "t 0 s"), "running:   0.0 %, t 0 s, time left unknown");
  EXPECT_EQ(Progress::line("settling", 0.25, 90, "t 1 s", Progress::End::limit),
            "settling:  25.0 %, t 1 s, at most 1 min 30 s left");
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

/// Work of one unit, at rate `fast` [1/s] until `busy` [s], then at `slow`; checked every `look` seconds.
struct Machine {
  double fast, busy, slow, look;
  double done(double t) const { return t < busy ? fast * t : fast * busy + slow * (t - busy); }
};

// Each bound is exact except for the window, a fifth of the elapsed time, and the last check before it.
TEST(TimeLeft, IsThatOfAnEvenRate) {
  TimeLeft left;
  for (int k = 1; k < 100; ++k) {
    left.add(k, 0.01 * k);
    EXPECT_NEAR(left.at(k).value(), 100 - k, 1e-9);
  }
}

TEST(TimeLeft, CountsDownUnderALoadThatStays) {
  const Machine m{0.01, 40, 0.002, 5}; // 40 % in 40 s, then another 300 s: five times slower
  TimeLeft left;
  double before = 1e300;
  for (double t = m.look; m.done(t) < 1; t += m.look) {
    left.add(t, m.done(t));
    const double now = left.at(t).value();
    if (t > m.busy + 20 + m.look) { // a mean rate since the start would grow until 80 s, and be wrong until the end
      EXPECT_LT(now, before) << t;
      EXPECT_NEAR(now, 340 - t, 1e-6) << t;
    }
    before = now;
  }
}

TEST(TimeLeft, CountsDownWhileNothingIsReportedAndThenIsUnknown) {
  TimeLeft left;
  left.add(100, 0.25); // one of four pieces
  EXPECT_NEAR(left.at(100).value(), 300, 1e-9);
  EXPECT_NEAR(left.at(180).value(), 220, 1e-9);
  EXPECT_FALSE(left.at(201)); // twice the time of the first piece: no estimate
  TimeLeft none;
  none.add(10, 0);
  EXPECT_FALSE(none.at(10));
}

TEST(TimeLeft, IsNeverNegative) {
  TimeLeft left;
  left.add(100, 0.9);
  EXPECT_NEAR(left.at(110).value(), 100.0 / 9 - 10, 1e-9);
  EXPECT_FALSE(left.at(112)); // overdue
}

TEST(TimeLeft, OfAResumedRunIsThatOfTheRest) {
  TimeLeft left(0.9);
  left.add(10, 0.91);
  EXPECT_NEAR(left.at(10).value(), 90, 1e-9);
}

TEST(TimeLeft, ManySamplesASecondChangeNothing) {
  TimeLeft left;
  for (int k = 1; k <= 100000; ++k) left.add(1e-3 * k, 1e-6 * k);
  EXPECT_NEAR(left.at(100).value(), 900, 1e-3);
}

} // namespace
} // namespace grouser::support

// SPDX-License-Identifier: BSD-3-Clause
// Error bars of --of: levels of the interim checks, coverage for known true values, and selected runs.
#include "runs/campaigns/sweeps/check_goals.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace grouser::sweeps {
namespace {

const SeedsFit kAnyFit = [](const std::vector<int>&) { return true; };
const std::string kFigure = "sinkage mean [m]";

RunCosts unitCosts() {
  RunCosts costs;
  costs.run = 1;
  return costs;
}

/// A figure with a known true value: a seed yields mean + scatter, and each case adds its own change and
/// scatter.
struct Truth {
  double mean = 1, deviation = 0.1;
  std::vector<double> changes = {}, changeDeviations = {}; ///< per axis: depth, width...
  bool skewed = false;                                     ///< exponential scatter, else normal
};

/// A check of synthetic runs: the values come from a generator, everything else from the functions of the check.
class SyntheticCheck {
public:
  SyntheticCheck(const Truth& truth, Looks looks, double percent, std::mt19937& dice)
      : truth_(truth), looks_(std::move(looks)), dice_(dice) {
    cases_.seeded = true;
    cases_.cases.resize(1 + truth.changes.size());
    const CheckAxis axes[] = {CheckAxis::depth, CheckAxis::width, CheckAxis::floor, CheckAxis::grainSize};
    for (std::size_t c = 1; c < cases_.cases.size(); ++c) cases_.cases[c].axis = axes[c - 1];
    asked_.seeded = true, asked_.percent = percent, asked_.levels = looks_.levels;
    for (int seed = 0; seed < looks_.most(); ++seed) draw();
  }

  /// Continues until the check stops; returns the goal.
  Goal run() {
    std::vector<int> next = firstLook(cases_, looks_, kAnyFit);
    for (;;) {
      taken_ = next;
      figure_ = figureNow();
      CheckResults results = asked_;
      results.figures = {figure_};
      const std::vector<Goal> goals = goalsOf(cases_, results, {kFigure}, looks_);
      next = nextLook(cases_, goals, taken_, looks_, unitCosts(), kAnyFit);
      if (next == taken_) return goals.front();
    }
  }

  bool valueHolds() const { return std::fabs(figure_.value.value - truth_.mean) <= figure_.value.halfWidth; }
  /// Whether the bar of an axis is at least the true change.
  bool axisHolds(std::size_t axis) const { return figure_.errors[axis].bar >= std::fabs(truth_.changes[axis]); }
  const CheckFigure& figure() const { return figure_; }
  const std::vector<int>& taken() const { return taken_; }

private:
  double scatter(double deviation) {
    return deviation * (truth_.skewed ? std::exponential_distribution<double>(1)(dice_) - 1
                                      : std::normal_distribution<double>(0, 1)(dice_));
  }
  void draw() {
    std::vector<double>& row = values_.emplace_back();
    row.push_back(truth_.mean + scatter(truth_.deviation));
    for (std::size_t c = 0; c < truth_.changes.size(); ++c)
      row.push_back(row[0] + truth_.changes[c] + scatter(truth_.changeDeviations[c]));
  }
  CheckFigure figureNow() const {
    CheckRuns runs;
    SweepFigures figures;
    figures.columns = {kFigure};
    for (std::size_t c = 0; c < taken_.size(); ++c)
      for (int seed = 0; seed < taken_[c]; ++seed) {
        runs.caseOf.push_back(c), runs.seedOf.push_back(seed + 1);
        figures.values.push_back({values_[static_cast<std::size_t>(seed)][c]});
      }
    return checkFigure(cases_, RunsByCase(runs, cases_.cases.size()), figures, 0, asked_);
  }

  Truth truth_;
  Looks looks_;
  std::mt19937& dice_;
  CheckCases cases_;
  sweeps::CheckResults asked_;
  std::vector<std::vector<double>> values_; // [seeds][cases]
  std::vector<int> taken_;
  CheckFigure figure_;
};

/// Checks 95 % intervals at every seed, and stops at the first narrow one: this rule undercovers.
Looks naiveLooks(int most) {
  Looks looks{std::vector<int>(static_cast<std::size_t>(most - kFewSeeds + 1)), {}};
  std::iota(looks.seeds.begin(), looks.seeds.end(), kFewSeeds);
  return looks;
}

constexpr int kTrials = 2000;
constexpr double kSpread = 0.0146; // three standard deviations of a share of 0.95 among so many

/// Share of checks that contain the true value, as judged by `holds`.
template <class Holds>
double coverage(const Truth& truth, const Looks& looks, double percent, unsigned seed, const Holds& holds) {
  std::mt19937 dice(seed);
  int held = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    SyntheticCheck check(truth, looks, percent, dice);
    check.run();
    held += holds(check) ? 1 : 0;
  }
  return static_cast<double>(held) / kTrials;
}

/// The mean lies within the interval of the value.
double valueCoverage(const Truth& truth, const Looks& looks, double percent) {
  return coverage(truth, looks, percent, 7, [](const SyntheticCheck& check) { return check.valueHolds(); });
}

/// The true change lies within the error bar of the first axis.
double axisCoverage(const Truth& truth, const Looks& looks, double percent) {
  return coverage(truth, looks, percent, 11, [](const SyntheticCheck& check) { return check.axisHolds(0); });
}

TEST(CheckGoals, LooksDoubleAndShareTheFivePercent) {
  const Looks looks = looksUpTo(24, true);
  EXPECT_EQ(looks.seeds, (std::vector{3, 6, 12, 24}));
  EXPECT_DOUBLE_EQ(looks.levels.value, 0.05 / 4);
  EXPECT_DOUBLE_EQ(looks.levels.change, 0.1 / 4); // only one side is counted
  EXPECT_EQ(looksUpTo(8, true).seeds, (std::vector{3, 6, 8}));
  EXPECT_EQ(looksUpTo(9, true).seeds, (std::vector{3, 6, 9}));
  EXPECT_EQ(looksUpTo(25, true).seeds, (std::vector{3, 6, 12, 25})) << "a check at 24 would only cost level";
  EXPECT_EQ(looksUpTo(2, true).seeds, (std::vector{2}));
  EXPECT_EQ(looksUpTo(8, false).seeds, (std::vector{1}));
  EXPECT_EQ(looks.after(0), 3);
  EXPECT_EQ(looks.after(6), 12);
  EXPECT_EQ(looks.after(24), 24);
}

TEST(CheckGoals, TheValueIsHeldInNinetyFivePercentWhereverTheCheckStops) {
  for (const double deviation : {0.03, 0.1, 0.2, 0.3, 0.5}) {
    const double held = valueCoverage({1, deviation}, looksUpTo(24, true), 20);
    EXPECT_GE(held, 0.95 - kSpread) << deviation;
  }
}

TEST(CheckGoals, StoppingAtTheFirstNarrowIntervalUndercovers) {
  double least = 1;
  for (const double deviation : {0.1, 0.2, 0.3})
    least = std::min(least, valueCoverage({1, deviation}, naiveLooks(24), 20));
  EXPECT_LT(least, 0.95 - 2 * kSpread);
}

TEST(CheckGoals, SkewedValuesAreHeldAboutAsOftenAsInAPlainCheck) {
  // Student's interval of three to twelve exponential values misses in more than 5 %, with or without interim checks.
  for (const double deviation : {0.1, 0.2, 0.3}) {
    const double held = valueCoverage({1, deviation, {}, {}, true}, looksUpTo(24, true), 20);
    std::mt19937 dice(7);
    int plain = 0;
    Looks once{{8}, {}};
    for (int trial = 0; trial < kTrials; ++trial) {
      SyntheticCheck check({1, deviation, {}, {}, true}, once, 20, dice);
      check.run();
      plain += check.valueHolds() ? 1 : 0;
    }
    EXPECT_GE(held, static_cast<double>(plain) / kTrials - kSpread) << deviation;
  }
}

TEST(CheckGoals, TheBarOfAnAxisHoldsItsTrueChangeWhereverTheCheckStops) {
  // The hardest case lies just above the target: the check continues until the change appears small enough.
  for (const double change : {0.1, 0.17, 0.2, 0.22})
    for (const double deviation : {0.05, 0.2}) {
      const double held = axisCoverage({1, 0.02, {change}, {deviation}}, looksUpTo(24, true), 20);
      EXPECT_GE(held, 0.95 - kSpread) << change << " +- " << deviation;
    }
}

TEST(CheckGoals, ReadingAnAxisAtEverySeedUndercovers) {
  double least = 1;
  for (const double deviation : {0.1, 0.2, 0.3})
    least = std::min(least, axisCoverage({1, 0.001, {0.21}, {deviation}}, naiveLooks(24), 20));
  EXPECT_LT(least, 0.95 - 2 * kSpread);
}

TEST(CheckGoals, SeedsGoWhereTheyNarrowTheBar) {
  std::mt19937 dice(3);
  // One of two axes scatters fifty times as much as the other.
  SyntheticCheck check({1, 0.02, {0, 0}, {0.002, 0.1}}, looksUpTo(24, true), 10, dice);
  const Goal goal = check.run();
  EXPECT_EQ(goal.state, GoalState::met);
  EXPECT_LE(goal.bar, 0.1 * goal.value);
  EXPECT_EQ(check.taken()[1], 3);
  EXPECT_GE(check.taken()[2], 12);
  EXPECT_GE(check.taken()[0], check.taken()[2]) << "pairs require base runs";
}

TEST(CheckGoals, WhereTheFirstLookIsEnoughNothingMoreIsRun) {
  std::mt19937 dice(3);
  SyntheticCheck check({1, 0.001, {0.002, 0}, {0.001, 0.001}}, looksUpTo(24, true), 10, dice);
  EXPECT_EQ(check.run().state, GoalState::met);
  EXPECT_EQ(check.taken(), (std::vector{3, 3, 3}));
}

TEST(CheckGoals, AnAxisThatDiffersByMoreThanTheBarEndsTheCheck) {
  std::mt19937 dice(3);
  SyntheticCheck check({1, 0.02, {0.4, 0.01}, {0.02, 0.02}}, looksUpTo(24, true), 10, dice);
  const Goal goal = check.run();
  EXPECT_EQ(goal.state, GoalState::limited);
  ASSERT_TRUE(goal.largest());
  EXPECT_EQ(goal.largest()->axis, CheckAxis::depth);
  EXPECT_EQ(check.taken(), (std::vector{3, 3, 3}));
}

TEST(CheckGoals, WhatTheMostSeedsDoNotReachIsNotBegun) {
  std::mt19937 dice(3);
  const Looks looks = looksUpTo(6, true);
  SyntheticCheck check({1, 1, {}, {}}, looks, 5, dice);
  const Goal goal = check.run();
  EXPECT_EQ(goal.state, GoalState::beyond);
  EXPECT_EQ(check.taken(), (std::vector{3}));
  CheckCases cases;
  cases.seeded = true, cases.cases.resize(1);
  // Deviation s needs about (1.96 s / 0.05)^2 seeds, more for the levels of the interim checks.
  Goal known = goal;
  known.parts[0].deviation = 0.09, known.wanted = 0.05;
  const std::vector<int> seeds = seedsToReach(cases, known, {3}, looks);
  ASSERT_EQ(seeds.size(), 1u);
  EXPECT_EQ(seeds[0], 24);
  // Student's quantile at 24 seeds is 2.40 at the level of two checks, which would suffice, and 2.71 at that of four.
  known.parts[0].deviation = 0.1;
  EXPECT_EQ(seedsToReach(cases, known, {3}, looks), (std::vector{48}));
  known.parts[0].deviation = 10;
  EXPECT_TRUE(seedsToReach(cases, known, {3}, looks).empty());
}

TEST(CheckGoals, TwoSeedsThatAreLeftOfThreeDoNotEndTheCheck) {
  BarPart part;
  part.axis = CheckAxis::floor, part.change = 5, part.deviation = 0.1, part.seeds = 2;
  EXPECT_EQ(part.least(24), 0);
  part.seeds = 3;
  EXPECT_GT(part.least(24), 4.5);
}

TEST(CheckGoals, ABudgetHoldsWhatItIsGiven) {
  std::mt19937 dice(3);
  CheckCases cases;
  cases.seeded = true, cases.cases.resize(3);
  cases.cases[1].axis = CheckAxis::depth, cases.cases[2].axis = CheckAxis::floor;
  cases.cases[1].cost = 5;
  const Looks looks = looksUpTo(24, true);
  const SeedsFit ten = [&](const std::vector<int>& s) { return secondsOf(cases, unitCosts(), s) <= 10; };
  const std::vector<int> first = firstLook(cases, looks, ten);
  EXPECT_EQ(first, (std::vector{3, 0, 3})) << "the expensive case comes later";
  EXPECT_EQ(firstLook(cases, looks, [](const std::vector<int>&) { return false; }), (std::vector{3, 0, 0}));
  Goal open;
  open.state = GoalState::open;
  EXPECT_EQ(secondLook(cases, {open}, first, looks, ten), first);
  EXPECT_EQ(secondLook(cases, {open}, first, looks, kAnyFit), (std::vector{3, 3, 3}));
  open.state = GoalState::limited;
  EXPECT_EQ(secondLook(cases, {open}, first, looks, kAnyFit), first) << "one axis shows that no run helps";
}

TEST(CheckGoals, TheCheaperOfTwoEqualCasesComesFirst) {
  CheckCases cases;
  cases.seeded = true, cases.cases.resize(3);
  cases.cases[1].axis = CheckAxis::grainSize, cases.cases[2].axis = CheckAxis::floor;
  cases.cases[1].cost = 5;
  const Looks looks = looksUpTo(24, true);
  Goal goal;
  goal.state = GoalState::open, goal.value = 1, goal.wanted = 0.21;
  // Three seeds of each axis leave 0.18 for both: one of them at six seeds is enough.
  for (std::size_t c = 0; c < 3; ++c) {
    BarPart& part = goal.parts.emplace_back();
    part.ofCase = c, part.axis = cases.cases[c].axis, part.seeds = 3, part.miss = looks.levels.change;
    part.deviation = c == 0 ? 0.001 : 0.05;
    part.bar = support::student(2, part.miss) * part.deviation / std::sqrt(3.0);
  }
  EXPECT_EQ(nextLook(cases, {goal}, {3, 3, 3}, looks, unitCosts(), kAnyFit), (std::vector{6, 3, 6}));
}

TEST(CheckGoals, CasesWithoutAPartInTheBarsAreRunWhereTheyAreNamed) {
  CheckCases cases;
  cases.seeded = true, cases.cases.resize(4);
  cases.cases[1].axis = CheckAxis::skin, cases.cases[2].axis = CheckAxis::precision;
  cases.cases[3].axis = CheckAxis::step, cases.cases[3].refinement = -1; // 2 h does not change the error bar
  CheckCases named = cases;
  keepGoalCases(cases, {});
  EXPECT_EQ(cases.cases.size(), 1u);
  EXPECT_EQ(cases.omitted.size(), 2u);
  keepGoalCases(named, {CheckAxis::skin, CheckAxis::precision});
  EXPECT_EQ(named.cases.size(), 3u);
  EXPECT_EQ(firstLook(named, looksUpTo(24, true), kAnyFit), (std::vector{3, 1, 3}));
}

TEST(CheckGoals, WhereRunsRepeatAllFinerStepsAreRun) {
  CheckCases cases;
  cases.cases.resize(4);
  for (int k = 1; k <= 3; ++k) {
    CheckCase& one = cases.cases[static_cast<std::size_t>(k)];
    one.axis = CheckAxis::step, one.refinement = k, one.cost = std::exp2(k);
  }
  const Looks looks = looksUpTo(24, false);
  const std::vector<int> first = firstLook(cases, looks, kAnyFit), all = {1, 1, 1, 1};
  EXPECT_EQ(first, (std::vector{1, 0, 0, 0}));
  for (const GoalState state : {GoalState::open, GoalState::met}) { // a bar from two steps may be narrow by chance
    Goal goal;
    goal.state = state;
    EXPECT_EQ(secondLook(cases, {goal}, first, looks, kAnyFit), all);
    EXPECT_EQ(nextLook(cases, {goal}, all, looks, unitCosts(), kAnyFit), all);
  }
}

TEST(CheckGoals, FiguresHaveShortNames) {
  const std::vector<std::string> columns = {"speed [m/s]", "sinkage mean [m]", "sinkage max [m]", "drive torque [N m]"};
  EXPECT_EQ(goalFigure("sinkage", columns), "sinkage mean [m]");
  EXPECT_EQ(goalFigure("sinkage_max", columns), "sinkage max [m]");
  EXPECT_EQ(goalFigure("torque", columns), "drive torque [N m]");
  EXPECT_EQ(goalFigure("Speed", columns), "speed [m/s]");
  EXPECT_EQ(goalFigure("drive torque [N m]", columns), "drive torque [N m]");
  try {
    goalFigure("tension", columns);
    FAIL();
  } catch (const base::InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "--of tension: unknown figure; choose from sinkage, torque, speed, sinkage_mean, sinkage_max, drive_torque");
  }
}

} // namespace
} // namespace grouser::sweeps

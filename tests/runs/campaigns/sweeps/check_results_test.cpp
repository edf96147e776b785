// SPDX-License-Identifier: BSD-3-Clause
// Results of a check from synthetic runs.
#include "runs/campaigns/sweeps/check_results.hpp"

#include "runs/campaigns/sweeps/check_goals_text.hpp"
#include "runs/campaigns/sweeps/check_report.hpp"
#include "runs/campaigns/sweeps/check_series.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

/// Student's 95 % quantile of two degrees of freedom, to the four digits that tables and this program have.
constexpr double kStudent = 4.303;

class CheckResults : public FolderTest {
protected:
  /// A case with one run per value: seeds 1, 2... NaN is a failed run.
  void add(CheckAxis axis, const std::string& name, int refinement, const std::vector<double>& values,
           const std::string& hash = "00") {
    CheckCase c;
    c.axis = axis, c.name = name, c.refinement = refinement;
    record_.cases.cases.push_back(c);
    for (std::size_t i = 0; i < values.size(); ++i) {
      SweepRun run;
      run.name = name + std::to_string(i);
      record_.runs.plan.runs.push_back(run);
      record_.runs.caseOf.push_back(record_.cases.cases.size() - 1);
      record_.runs.seedOf.push_back(static_cast<std::int64_t>(i) + 1);
      const bool failed = std::isnan(values[i]);
      record_.outcomes.push_back(failed ? SweepOutcome{output::RunStatus::failed, "it broke"}
                                        : SweepOutcome{output::RunStatus::finished, ""});
      const std::filesystem::path folder = folder_ / run.name;
      std::filesystem::create_directory(folder);
      std::ofstream(folder / "manifest.json")
          << "{\"wall_time_s\": " << 10 << ", \"state_hash\": \"" << hash << i << "\", \"figures\": {}}\n";
      if (!failed)
        std::ofstream(folder / "timeseries.csv")
            << "step,time [s],depth [m],terrain.rebuilds [-],left over [m]\n0,0,1,0,0\n1,0.5," << 2 * values[i]
            << ",1,0\n2,1," << values[i] << ",2," << leftOver_ << "\n";
      record_.runs.series.push_back(failed ? RunSeries{} : readSeries(folder));
    }
  }
  sweeps::CheckResults results(double percent = 5) const {
    return checkResults(record_.cases, record_.runs, record_.outcomes, folder_, percent);
  }
  CheckFigure depth(double percent = 5) const { return figure("depth [m] at the end", percent); }
  CheckFigure figure(const std::string& name, double percent = 5) const {
    for (const CheckFigure& f : results(percent).figures)
      if (f.name == name) return f;
    ADD_FAILURE() << "no such figure";
    return {};
  }
  static AxisError errorBy(const CheckFigure& figure, CheckAxis axis) {
    for (const AxisError& e : figure.errors)
      if (e.axis == axis) return e;
    ADD_FAILURE() << base::wordOf(axis) << " is missing";
    return {};
  }
  void SetUp() override {
    FolderTest::SetUp();
    record_.folder = folder_, record_.cases.seeded = true;
  }

  CheckRecord record_;
  double leftOver_ = 0;
};

TEST_F(CheckResults, DifferencesAreTakenSeedBySeed) {
  add(CheckAxis::base, "base", 0, {10, 11, 12});
  add(CheckAxis::depth, "deeper", 0, {12, 13.1, 13.9});
  const CheckFigure f = depth();
  EXPECT_DOUBLE_EQ(f.value.value, 11);
  EXPECT_NEAR(f.value.halfWidth, kStudent / std::sqrt(3.0), 1e-6);
  const AxisError e = errorBy(f, CheckAxis::depth);
  EXPECT_NEAR(e.change.value, 2, 1e-12);
  EXPECT_NEAR(e.change.halfWidth, kStudent * 0.1 / std::sqrt(3.0), 1e-6); // not from the scatter of the values
  EXPECT_EQ(e.verdict, jobs::Verdict::differs);
  EXPECT_NEAR(f.bar, std::hypot(f.value.halfWidth, 2 + e.change.halfWidth), 1e-9);
}

TEST_F(CheckResults, ASeedThatFailedIsLeftOutOfItsPair) {
  add(CheckAxis::base, "base", 0, {10, 11, 12});
  add(CheckAxis::width, "wider", 0, {10.1, NAN, 12.1});
  const AxisError e = errorBy(depth(), CheckAxis::width);
  EXPECT_EQ(e.seeds, 2);
  EXPECT_NEAR(e.change.value, 0.1, 1e-12);
  EXPECT_EQ(statusOf(record_, 1).word, "partly failed");
  EXPECT_EQ(statusOf(record_, 1).message, "1 of 3 runs failed: it broke");
  add(CheckAxis::floor, "lower", 0, {NAN, NAN, NAN});
  EXPECT_EQ(statusOf(record_, 2).word, "failed");
}

TEST_F(CheckResults, ABarWithoutAFailedCaseIsNotCalledMet) {
  add(CheckAxis::base, "base", 0, {10, 11, 12});
  record_.looks.seeds = {3};
  Goal goal;
  goal.figure = "depth [m]", goal.value = 11, goal.bar = 1, goal.wanted = 2, goal.state = GoalState::met;
  record_.goals = {goal}, record_.toReach = {{}};
  EXPECT_TRUE(goalsJson(record_)[0].at("met"));
  EXPECT_NE(goalsText(record_, 20).find("  met"), std::string::npos);
  add(CheckAxis::floor, "lower", 0, {10, NAN, 12});
  EXPECT_FALSE(goalsJson(record_)[0].at("met"));
  EXPECT_EQ(goalsJson(record_)[0].at("missing"), nlohmann::ordered_json({"lower (partly failed)"}));
  EXPECT_NE(goalsText(record_, 20).find("inconclusive"), std::string::npos);
}

TEST_F(CheckResults, TheStepsOrderIsOfBothSides) {
  add(CheckAxis::base, "base", 0, {10, 11, 12});
  add(CheckAxis::step, "half", 1, {9.9, 10.9, 11.9});
  add(CheckAxis::step, "twice", -1, {10.2, 11.2, 12.2});
  const AxisError e = errorBy(depth(), CheckAxis::step);
  ASSERT_TRUE(e.order);
  EXPECT_NEAR(*e.order, 1, 1e-9);
  EXPECT_NEAR(e.change.value, -0.2, 1e-9); // extrapolated to zero step
  EXPECT_DOUBLE_EQ(depth().value.value, 11) << "the value is that of the unchanged scene";
}

TEST_F(CheckResults, PrecisionIsNoPartOfABarOverSeeds) {
  add(CheckAxis::base, "base", 0, {10, 11, 12});
  const double alone = depth().bar;
  add(CheckAxis::precision, "double", 0, {12, 11, 10});
  EXPECT_DOUBLE_EQ(depth().bar, alone);
  EXPECT_EQ(errorBy(depth(), CheckAxis::precision).seeds, 3);
}

TEST_F(CheckResults, WhereSeedsMakeNoDifferenceTheStepsTellTheError) {
  record_.cases.seeded = false;
  add(CheckAxis::base, "base", 0, {3.8});
  add(CheckAxis::step, "half", 1, {3.4});
  add(CheckAxis::step, "quarter", 2, {3.2});
  add(CheckAxis::step, "eighth", 3, {3.1});
  const CheckFigure f = depth();
  EXPECT_EQ(f.value.halfWidth, 0);
  const AxisError e = errorBy(f, CheckAxis::step);
  EXPECT_NEAR(e.change.value, -0.8, 1e-9); // 3 at zero step
  EXPECT_NEAR(f.bar, 1.25 * 0.8, 1e-9);
  // Also for other steps: two values remain for the quarter, none for the eighth.
  const std::vector<double> bars = f.barOfStep;
  ASSERT_EQ(bars.size(), 4U);
  EXPECT_NEAR(bars[2], 0.2, 1e-9);
  EXPECT_TRUE(std::isnan(bars[3]));
}

TEST_F(CheckResults, TheSkinMustGiveTheSameBits) {
  add(CheckAxis::base, "base", 0, {10, 11});
  EXPECT_EQ(results().skin, SameBits::notRun);
  add(CheckAxis::skin, "skin", 0, {10});
  EXPECT_EQ(results().skin, SameBits::yes);
  record_.cases.cases.pop_back(), record_.runs.plan.runs.pop_back(), record_.outcomes.pop_back();
  record_.runs.caseOf.pop_back(), record_.runs.seedOf.pop_back(), record_.runs.series.pop_back();
  std::filesystem::remove_all(folder_ / "skin0");
  add(CheckAxis::skin, "skin", 0, {10}, "01");
  EXPECT_EQ(results().skin, SameBits::no);
}

TEST_F(CheckResults, SeedsArePairedInWhateverOrderTheirRunsAre) {
  add(CheckAxis::base, "base", 0, {10, 11, 12});
  add(CheckAxis::width, "wider", 0, {12.2, 10.1, 11.3});
  record_.runs.seedOf = {1, 2, 3, 3, 1, 2};
  const AxisError e = errorBy(depth(), CheckAxis::width);
  EXPECT_EQ(e.seeds, 3);
  EXPECT_NEAR(e.change.value, 0.2, 1e-12);
  EXPECT_NEAR(e.change.halfWidth, kStudent * 0.1 / std::sqrt(3.0), 1e-6);
  record_.runs.seedOf = {1, 2, 3, 4, 5, 2}; // one seed in common
  EXPECT_EQ(errorBy(depth(), CheckAxis::width).seeds, 1);
}

TEST_F(CheckResults, OfManySeedsPairsAreFoundInTime) {
  constexpr int kSeeds = 100'000; // a quadratic algorithm would take a minute
  CheckRuns runs;
  for (std::size_t c = 0; c < 2; ++c)
    for (int s = 0; s < kSeeds; ++s) runs.caseOf.push_back(c), runs.seedOf.push_back(kSeeds - s);
  const std::vector<std::vector<std::size_t>> pairs = RunsByCase(runs, 2).sharing({0, 1});
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kSeeds));
  for (const std::vector<std::size_t>& pair : pairs) ASSERT_EQ(pair[1], pair[0] + kSeeds);
}

TEST_F(CheckResults, RoundingIsToldByTheLargestFigureOfItsUnit) {
  record_.cases.seeded = false;
  leftOver_ = 1e-14; // beside a depth of some metres
  add(CheckAxis::base, "base", 0, {3.8});
  add(CheckAxis::step, "half", 1, {3.4});
  EXPECT_TRUE(isAboveRounding(depth()));
  EXPECT_FALSE(isAboveRounding(figure("left over [m] at the end")));
  // Beside lengths below a nanometre it is significant.
  record_ = {}, record_.folder = folder_;
  std::filesystem::remove_all(folder_ / "base0"), std::filesystem::remove_all(folder_ / "half0");
  add(CheckAxis::base, "base", 0, {3.8e-9});
  add(CheckAxis::step, "half", 1, {3.4e-9});
  EXPECT_TRUE(isAboveRounding(depth()));
  EXPECT_TRUE(isAboveRounding(figure("left over [m] at the end")));
}

TEST_F(CheckResults, WithoutFinerStepsTheBarIsOfTheOtherAxesUnlessTheStepIsAsked) {
  record_.cases.seeded = false;
  add(CheckAxis::base, "base", 0, {3.8});
  EXPECT_TRUE(std::isinf(depth().bar)) << "no axis at all";
  add(CheckAxis::precision, "double", 0, {3.9});
  EXPECT_NEAR(depth().bar, 0.1, 1e-12);
  record_.costs = costsOf(record_);
  const std::string text = checkText(record_, results());
  EXPECT_NE(text.find("error bars include precision, but not the time step: add step to --axes"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("cheapest"), std::string::npos) << text;
  add(CheckAxis::step, "half", 1, {});
  EXPECT_TRUE(std::isinf(depth().bar)) << "its runs have not finished";
  record_.costs = costsOf(record_);
  const std::string missing = checkText(record_, results());
  EXPECT_NE(missing.find("no error bars, because they require the error of the time step: no run with a smaller time "
                         "step has finished"),
            std::string::npos)
      << missing;
  EXPECT_EQ(missing.find('?'), std::string::npos) << missing;
}

TEST_F(CheckResults, RunsWithoutAHashSayNothingOfTheSkin) {
  add(CheckAxis::base, "base", 0, {10});
  add(CheckAxis::skin, "skin", 0, {10});
  std::ofstream(folder_ / "skin0/manifest.json") << "{}\n";
  EXPECT_EQ(results().skin, SameBits::notRun);
}

TEST_F(CheckResults, TheCheapestSettingHoldsStepAndSeedsTogether) {
  add(CheckAxis::base, "base", 0, {10, 10.1, 9.9, 10});
  add(CheckAxis::step, "half", 1, {9.9, 10.0, 9.8, 9.9});
  record_.costs = costsOf(record_);
  const Cheapest ten = cheapest(record_, results(), depth(), 10), tenth = cheapest(record_, results(), depth(), 0.1);
  EXPECT_EQ(ten.name, "base");
  EXPECT_EQ(ten.seeds, 2); // t of one degree of freedom times 0.0816 / sqrt(2) is below 0.99
  EXPECT_DOUBLE_EQ(ten.wall, 20);
  EXPECT_EQ(tenth.name, ""); // only the step exceeds the bar
}

TEST_F(CheckResults, SeriesHaveAValueAndABarAtEveryTime) {
  add(CheckAxis::base, "base", 0, {10, 11, 12});
  add(CheckAxis::step, "half", 1, {9.9, 10.9, 11.9});
  const CheckSeries s = checkSeries(record_.cases, record_.runs, record_.outcomes);
  EXPECT_EQ(s.time, (std::vector<double>{0, 0.5, 1}));
  ASSERT_EQ(s.series.size(), 2U); // the ground has no rebuilds
  EXPECT_EQ(s.series[0].name, "depth [m]");
  EXPECT_EQ(s.series[0].value, (std::vector<double>{1, 22, 11}));
  EXPECT_NEAR(s.series[0].step[1], 2 * 0.2, 1e-9);
  EXPECT_NEAR(s.series[0].seeds[1], 2 * kStudent / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(s.series[0].both[1], std::hypot(s.series[0].seeds[1], s.series[0].step[1]), 1e-9);
}

TEST_F(CheckResults, TheParameterErrorIsTheIntervalOfOneMoreSample) {
  record_.cases.seeded = false;
  add(CheckAxis::base, "base", 0, {10});
  add(CheckAxis::nodeSpacing, "nodes", 0, {10.5});
  add(CheckAxis::parameter, "draw_1", 0, {9}), add(CheckAxis::parameter, "draw_2", 0, {10});
  add(CheckAxis::parameter, "draw_3", 0, {12.5});
  const CheckFigure f = depth();
  const AxisError e = errorBy(f, CheckAxis::parameter);
  EXPECT_EQ(e.seeds, 3);
  EXPECT_NEAR(e.change.value, 0.5, 1e-12);
  // Samples deviate by -1, 0 and 2.5: s = 1.803; a further one lies within t s sqrt(1 + 1/3) of their mean.
  const double halfWidth = kStudent * std::sqrt(3.25) * std::sqrt(4.0 / 3);
  EXPECT_NEAR(e.change.halfWidth, halfWidth, 1e-3);
  EXPECT_NEAR(e.bar, 0.5 + halfWidth, 1e-3);
  EXPECT_NEAR(errorBy(f, CheckAxis::nodeSpacing).bar, 2 * 0.5, 1e-12);
}

} // namespace
} // namespace grouser::sweeps

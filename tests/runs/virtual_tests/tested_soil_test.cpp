// SPDX-License-Identifier: BSD-3-Clause
// Soil files: scaling with grain size, and errors with their location.
#include "base/error.hpp"
#include "runs/scene/soil.hpp"
#include "runs/virtual_tests/plan.hpp"
#include "runs/virtual_tests/preparation.hpp"
#include "runs/virtual_tests/results.hpp"
#include "runs/virtual_tests/tested_soil.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace grouser::virtual_tests {

using namespace test; // fixtures

namespace {

constexpr const char* kSoil = "version = 1\n"
                              "[soil]\n"
                              "title = \"a sand\"\n"
                              "description = \"of a test\"\n"
                              "[material]\n"
                              "density = 2600\n"
                              "stiffness = 2e5\n"
                              "restitution = 0.3\n"
                              "friction = 0.6\n"
                              "rolling_friction = 0.15\n"
                              "cohesion = 0.5\n"
                              "[bed]\n"
                              "grain_radius = 0.007\n"
                              "radius_spread = 0.2\n"
                              "porosity = 0.41\n"
                              "calibrated_radii = [0.005, 0.010]\n"
                              "[[published]]\n"
                              "quantity = \"c\"\n"
                              "value = 1300\n"
                              "unit = \"Pa\"\n"
                              "source = \"Wong 2008\"\n";

class SoilFile : public FolderTest {
protected:
  /// The error of a file that is `text` with one piece replaced.
  std::string errorWith(const std::string& what, const std::string& by) const {
    std::string text = kSoil;
    text.replace(text.find(what), what.size(), by);
    put(folder_ / "soil.toml", text);
    try {
      readTestedSoil(folder_ / "soil.toml", 0);
    } catch (const base::InputError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(SoilFile, IsGradedWhereStiffnessAndPullKnowTheRadius) {
  std::string hertz = kSoil;
  hertz.replace(hertz.find("stiffness = 2e5"), 15, "law = \"hertz\"\nyoung = 2e8");
  const auto graded = [this](const std::string& text) {
    put(folder_ / "soil.toml", text);
    return planOf(readTestedSoil(folder_ / "soil.toml", 0), {}).large.strip.coarsening > 0;
  };
  EXPECT_FALSE(graded(kSoil)) << "equal stiffness at all sizes";
  EXPECT_FALSE(graded(hertz)) << "equal adhesion energy at all sizes";
  std::string grows = hertz, dry = hertz;
  grows.replace(grows.find("cohesion = 0.5"), 14, "cohesion = 0.5\nadhesion_radius = 0.007");
  dry.replace(dry.find("cohesion = 0.5"), 14, "cohesion = 0");
  EXPECT_TRUE(graded(grows));
  EXPECT_TRUE(graded(dry));
  const TestedSoil soil = readTestedSoil(folder_ / "soil.toml", 0.014);
  EXPECT_EQ(soil.lawWithoutPull.find("cohesion"), std::string::npos);
  put(folder_ / "soil.toml", grows);
  EXPECT_EQ(numberOf(readTestedSoil(folder_ / "soil.toml", 0.014), "adhesion_radius", 0), 0.014);
}

TEST_F(SoilFile, StiffnessAndCohesionGrowWithTheGrains) {
  put(folder_ / "soil.toml", kSoil);
  const TestedSoil as = readTestedSoil(folder_ / "soil.toml", 0), twice = readTestedSoil(folder_ / "soil.toml", 0.014);
  EXPECT_EQ(as.name, "soil");
  EXPECT_EQ(as.title, "a sand");
  EXPECT_EQ(as.density, 2600);
  EXPECT_EQ(as.friction, 0.6);
  EXPECT_EQ(as.grainRadius, 0.007);
  EXPECT_EQ(as.porosity, 0.41);
  EXPECT_FALSE(as.isPlain) << "it is cohesive";
  EXPECT_NE(as.law.find("stiffness = 200000"), std::string::npos) << as.law;
  EXPECT_NE(twice.law.find("stiffness = 400000"), std::string::npos) << twice.law;
  EXPECT_NE(twice.law.find("cohesion = 1.0"), std::string::npos) << twice.law;
  EXPECT_NE(twice.law.find("rolling_friction = 0.15"), std::string::npos) << twice.law;
  EXPECT_EQ(as.law.find("friction = 0.6"), std::string::npos) << "the tests may vary it";
  EXPECT_TRUE(as.isCalibrated());
  EXPECT_FALSE(twice.isCalibrated());
  ASSERT_EQ(as.published.size(), 1u);
  EXPECT_NEAR(as.published[0].value, 1.3, 1e-12) << "in kPa";
}

TEST_F(SoilFile, WhatIsWrongIsNamedWithFileLineAndKey) {
  const std::string typo = errorWith("friction = 0.6", "fricton = 0.6");
  EXPECT_NE(typo.find("soil.toml:9"), std::string::npos) << typo;
  EXPECT_NE(typo.find("friction"), std::string::npos) << typo;
  const std::string range = errorWith("restitution = 0.3", "restitution = 1.3");
  EXPECT_NE(range.find("soil.toml:8"), std::string::npos) << range;
  EXPECT_NE(range.find("[0, 1]"), std::string::npos) << range;
  const std::string unit = errorWith("unit = \"Pa\"", "unit = \"psi\"");
  EXPECT_NE(unit.find("soil.toml:20"), std::string::npos) << unit;
  EXPECT_NE(unit.find("Pa"), std::string::npos) << unit;
  const std::string quantity = errorWith("quantity = \"c\"", "quantity = \"k_phy\"");
  EXPECT_NE(quantity.find("soil.toml:18"), std::string::npos) << quantity;
  EXPECT_NE(quantity.find("k_phi"), std::string::npos) << quantity;
  EXPECT_NE(errorWith("grain_radius = 0.007\n", "").find("grain_radius"), std::string::npos);
  EXPECT_NE(errorWith("[bed]", "[beds]").find("bed"), std::string::npos);
  EXPECT_NE(errorWith("[0.005, 0.010]", "[0.010, 0.005]").find("soil.toml:16"), std::string::npos);
}

TEST_F(SoilFile, ANameThatIsNoneIsToldWithTheNearest) {
  try {
    readTestedSoil("no_such_soil", 0);
    FAIL() << "no such soil";
  } catch (const base::InputError& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find("no_such_soil"), std::string::npos) << message;
    for (const auto& [name, file] : scene::knownSoils("")) EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

TestedSoil sand(bool hertz) {
  TestedSoil soil;
  soil.name = "sand", soil.density = 2500, soil.friction = 0.5, soil.grainRadius = soil.fileRadius = 0.01;
  soil.spread = 0.25, soil.isPlain = !hertz;
  if (hertz) soil.young = 2e8, soil.poisson = 0.25, soil.isOneAtAllSizes = true;
  soil.law = hertz ? "law = \"hertz\"\nyoung = 2e8\n" : "stiffness = 1e5\n";
  return soil;
}

TEST(SoilPlan, FullCareIsWhatASoilNeeds) {
  const TestPlan plan = planOf(sand(true), {});
  std::map<TestKind, int> count;
  for (const PlannedTest& t : plan.tests) ++count[t.kind];
  EXPECT_EQ(count[TestKind::small], 8);
  EXPECT_EQ(count[TestKind::large], 3);
  EXPECT_EQ(count[TestKind::wide], 8);
  EXPECT_EQ(count[TestKind::shear], 8 * 4);
  EXPECT_GE(plan.small.strip.breadth, 20);
  EXPECT_GE(plan.breadth(TestKind::large), 3 * plan.breadth(TestKind::small) * (1 - 1e-12));
  EXPECT_GE(plan.small.strip.bin, 5);
  EXPECT_GE(plan.small.strip.depth, 2);
  EXPECT_EQ(plan.wide.strip.bin, 2 * plan.small.strip.bin);
  PlanOptions narrow;
  narrow.wide = false;
  EXPECT_EQ(planOf(sand(true), narrow).tests.size(), plan.tests.size() - 8);
  EXPECT_LE(plan.small.strip.inertialNumber, 1.8e-3);
  EXPECT_LT(plan.options.loads.front(), kTrackPressure);
  EXPECT_GT(plan.options.loads.back(), kTrackPressure);
  EXPECT_EQ(plan.care(), "full");
  EXPECT_EQ(planOf(sand(true), coarsePlan()).care(), "coarse");
  EXPECT_EQ(planOf(sand(true), coarsePlan()).tests.front().name, "coarse_small_seed1");
  // Beds of both widths are poured in lifts of equal thickness.
  EXPECT_EQ(plan.large.preparation(plan.grains).lift, plan.small.preparation(plan.grains).lift);
}

TEST(SoilPlan, SeveralProcessesBeginWithTheLongest) {
  const TestPlan plan = planOf(sand(true), coarsePlan());
  std::vector<const PlannedTest*> tests;
  for (const PlannedTest& test : plan.tests) tests.push_back(&test);
  longestFirst(tests);
  ASSERT_EQ(tests.size(), plan.tests.size());
  EXPECT_EQ(tests.front()->name, "coarse_large_seed1");
  for (std::size_t k = 1; k < tests.size(); ++k) {
    EXPECT_GE(tests[k - 1]->cost, tests[k]->cost);
    EXPECT_TRUE(tests[k - 1]->cost > tests[k]->cost || tests[k - 1]->seed < tests[k]->seed) << tests[k]->name;
  }
}

TEST(SoilPlan, OnlyLawsThatKnowTheRadiusAreGraded) {
  EXPECT_GT(planOf(sand(true), {}).large.strip.coarsening, 0);
  EXPECT_EQ(planOf(sand(false), {}).large.strip.coarsening, 0);
  EXPECT_EQ(planOf(sand(true), {}).small.strip.coarsening, 0);
  EXPECT_GT(planOf(sand(true), {}).grains.impactSpeed, 0) << "the stiffness of Hertz contacts grows with the load";
  EXPECT_THROW(
      {
        PlanOptions thin;
        thin.thickness = 4;
        planOf(sand(true), thin);
      },
      base::InputError);
}

TEST(SoilPlan, LayersAreOfOneHeightWhereGrainsAreFine) {
  TestedSoil fine = sand(true);
  fine.grainRadius = 0.0035;
  EXPECT_NEAR(planOf(fine, {}).cell.depth * 0.007, 0.14, 1e-12);
  EXPECT_NEAR(planOf(sand(true), {}).cell.depth, 10, 1e-12) << "at least ten grains";
}

TEST(SoilPreparation, FrictionsAreTriedUntilThePorosityIsThere) {
  // Porosities typical of sphere beds, about evenly distributed in the logarithm of the friction.
  const auto porosity = [](double tried) { return 0.40 + 0.012 * std::log(tried / 0.3); };
  std::vector<std::vector<double>> trials;
  double friction = 0;
  while ((friction = nextFriction(trials, 0.385, 0.002)) > 0) trials.push_back({friction, porosity(friction)});
  EXPECT_NEAR(nearestTrial(trials, 0.385)[1], 0.385, 0.002);
  EXPECT_LE(trials.size(), 5u);
  trials.clear();
  while ((friction = nextFriction(trials, 0.5, 0.002)) > 0) trials.push_back({friction, porosity(friction)});
  EXPECT_EQ(nearestTrial(trials, 0.5)[0], kMaxSettlingFriction) << "out of reach: the loosest bed";
  trials.clear();
  while ((friction = nextFriction(trials, 0.2, 0.002)) > 0) trials.push_back({friction, porosity(friction)});
  EXPECT_EQ(nearestTrial(trials, 0.2)[0], kMinSettlingFriction) << "out of reach: the densest bed";
}

PublishedValue published(Quantity quantity, double value) { return {quantity, value, {}, {}, "a source"}; }

TEST(SoilVerdict, SpansAreThoseOfTwoSourcesOrOneWidened) {
  TestedSoil soil = sand(true);
  EXPECT_FALSE(publishedSpan(soil, Quantity::frictionAngle));
  soil.published = {published(Quantity::frictionAngle, 31.1), published(Quantity::exponent, 0.8)};
  const PublishedSpan one = *publishedSpan(soil, Quantity::frictionAngle);
  EXPECT_TRUE(one.isTolerance);
  EXPECT_NEAR(one.low, 29.1, 1e-12);
  EXPECT_NEAR(one.high, 33.1, 1e-12);
  EXPECT_NEAR(publishedSpan(soil, Quantity::exponent)->low, 0.68, 1e-12);
  soil.published.push_back(published(Quantity::frictionAngle, 30));
  const PublishedSpan two = *publishedSpan(soil, Quantity::frictionAngle);
  EXPECT_FALSE(two.isTolerance);
  EXPECT_EQ(two.low, 30);
  EXPECT_EQ(two.high, 31.1);
  soil.published.back().low = 27;
  EXPECT_EQ(publishedSpan(soil, Quantity::frictionAngle)->low, 27);
}

TEST(PublishedModulus, IsThatOfAPlateOfItsBreadthFromASourceThatHasAllThree) {
  TestedSoil soil = sand(true);
  soil.published = {published(Quantity::exponent, 0.8), published(Quantity::frictionModulus, 5000)};
  EXPECT_FALSE(publishedModulus(soil, 0.28)) << "without k_c";
  soil.published.push_back(published(Quantity::cohesionModulus, 140));
  const PublishedSpan span = *publishedModulus(soil, 0.28);
  EXPECT_NEAR(span.low, 0.6 * 5500, 1e-9);
  EXPECT_NEAR(span.high, 1.4 * 5500, 1e-9);
  EXPECT_TRUE(span.isTolerance);
  soil.published.back().source = "another source";
  EXPECT_FALSE(publishedModulus(soil, 0.28)) << "values from two sources do not form a set";
  soil.published.back() = published(Quantity::cohesionModulus, -202);
  EXPECT_FALSE(publishedModulus(soil, 0.03)) << "a negative value is invalid for so small a plate";
}

TEST(PublishedModulus, IsKnownOfEverySoilWhoseThreeNumbersArePublished) {
  for (const char* name : {"dry_sand", "grenville_loam", "lete_sand", "sandy_loam"})
    EXPECT_TRUE(publishedModulus(readTestedSoil(name, 0), 0.28)) << name << ": a single source";
}

TEST(SoilVerdict, AWideIntervalIsNotInside) {
  const PublishedSpan span{30, 32};
  EXPECT_EQ(verdictOf({31, 0.5}, span), "inside");
  EXPECT_EQ(verdictOf({31, 1.5}, span), "inside, interval is wider");
  EXPECT_EQ(verdictOf({33, 1.5}, span), "outside, interval reaches in");
  EXPECT_EQ(verdictOf({33, 0.5}, span), "outside");
}

TEST(PlateUnloading, StiffnessIsTheSlopeOfThePressure) {
  jobs::Table run;
  run.names = kSinkageColumns;
  const auto row = [&](double phase, double z, double p) { run.rows.push_back({phase, z, p, 0.4, 1, 1, 1, 1, 1}); };
  for (int i = 1; i <= 100; ++i) row(0, 1e-3 * i, 1e3 * i);
  for (int i = 0; i <= 50; ++i) row(1, 0.1 - 1e-4 * i, 100e3 - 2e3 * i);
  for (int i = 0; i <= 50; ++i) row(2, 0.095 + 1e-4 * i, 2e3 * i);
  const Unloading u = unloadingOf(run);
  EXPECT_NEAR(u.from, 96.5e3, 1) << "the mean of the last eight rows";
  EXPECT_NEAR(u.stiffness, 2e7, 1);
  EXPECT_NEAR(u.reloading, 2e7, 1);
  EXPECT_EQ(loadingCurve(run).sinkage.size(), 100u);
}

TEST(Repose, IsTheTiltAtWhichAFlowEnds) {
  const ReposeTest test;
  jobs::Table run;
  run.names = kReposeColumns;
  for (const auto& [tilt, speed] : std::vector<std::pair<double, double>>{
           {24, 1e-4}, {25, 0.02}, {26, 0.15}, {25.5, 0.2}, {25, 0.05}, {24.5, 0.004}})
    run.rows.push_back({tilt, speed, 0.4});
  const ReposeAngles angles = reposeAngles(run, test);
  EXPECT_EQ(angles.starts, 26);
  EXPECT_EQ(angles.repose, 24.5);
  run.rows.resize(2);
  EXPECT_TRUE(std::isnan(reposeAngles(run, test).repose)) << "no flow occurred";
}

} // namespace
} // namespace grouser::virtual_tests

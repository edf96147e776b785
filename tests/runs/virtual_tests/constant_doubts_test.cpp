// SPDX-License-Identifier: BSD-3-Clause
// Implausible constants, and constants without interval, are inconclusive.
#include "runs/virtual_tests/calibration.hpp"
#include "runs/virtual_tests/constant_doubts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grouser::virtual_tests {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

TEST(ConstantDoubts, NameWhatNoSoilHas) {
  EXPECT_EQ(doubtOf(Quantity::frictionModulus, {5301, 400}), "");
  EXPECT_NE(doubtOf(Quantity::frictionModulus, {-1049, kUnknown}).find("not positive"), std::string::npos);
  EXPECT_NE(doubtOf(Quantity::frictionModulus, {-1049, kUnknown}).find("no interval"), std::string::npos);
  EXPECT_NE(doubtOf(Quantity::frictionModulus, {-1049, 10}), "");
  EXPECT_NE(doubtOf(Quantity::frictionModulus, {3339, 5800}).find("wider than the value"), std::string::npos);
  EXPECT_NE(doubtOf(Quantity::frictionModulus, {std::nan(""), kUnknown}), "");
  for (const double n : {0.1, 0.8, 1.27, 2.0}) EXPECT_EQ(doubtOf(Quantity::exponent, {n, 0.05}), "") << n;
  for (const double n : {-0.3, 0.05, 2.1}) EXPECT_NE(doubtOf(Quantity::exponent, {n, 0.01}), "") << n;
  EXPECT_NE(doubtOf(Quantity::frictionAngle, {72, 1}), "");
  EXPECT_NE(doubtOf(Quantity::shearModulus, {0, 0}), "");
}

TEST(ConstantDoubts, LeaveBothSignsToTheCohesionModulusAndScatterToCohesion) {
  EXPECT_EQ(doubtOf(Quantity::cohesionModulus, {-202, 50}), "") << "GRC-1's";
  EXPECT_EQ(doubtOf(Quantity::cohesion, {0.02, 0.3}), "") << "dry sand";
  EXPECT_EQ(doubtOf(Quantity::cohesion, {-0.1, 0.3}), "");
  EXPECT_NE(doubtOf(Quantity::cohesion, {-0.5, 0.3}), "");
  EXPECT_NE(doubtOf(Quantity::cohesionModulus, {100, kUnknown}), "") << "one seed only";
}

TEST(ConstantDoubts, AreOneLineWithTheRemedy) {
  SoilResults r;
  r.measured = {{Quantity::exponent, {0.9, 0.1}}, {Quantity::frictionModulus, {-1049, kUnknown}}};
  TestPlan plan;
  plan.options.coarse = true, plan.options.seeds = 3, plan.options.largeSeeds = 1;
  const std::string text = doubtsText(r, plan);
  EXPECT_EQ(text.find("inconclusive: k_phi = -1"), 0u) << text;
  EXPECT_NE(text.find("raise --large-seeds, or remove --quick"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  r.measured[Quantity::frictionModulus] = {1049, 100};
  EXPECT_EQ(doubtsText(r, plan), "");
}

TEST(ConstantDoubts, AreNotWrittenIntoASoilsFile) {
  SoilResults r;
  r.measured = {{Quantity::exponent, {0.9, 0.1}}, {Quantity::frictionModulus, {-1049, 30}}};
  TestedSoil soil;
  soil.name = "sand", soil.grainRadius = 0.007;
  const std::string file = soilFileText(soil, "a trial", r, "grouser soil");
  EXPECT_NE(file.find("quantity = \"n\""), std::string::npos) << file;
  EXPECT_EQ(file.find("quantity = \"k_phi\""), std::string::npos) << file;
  EXPECT_NE(file.find("# k_phi = "), std::string::npos) << file;
  EXPECT_NE(file.find("calibrated = true"), std::string::npos) << file;
  r.measured = {{Quantity::frictionModulus, {-1049, 30}}};
  EXPECT_NE(soilFileText(soil, "a trial", r, "grouser soil").find("calibrated = false"), std::string::npos);
}

} // namespace
} // namespace grouser::virtual_tests

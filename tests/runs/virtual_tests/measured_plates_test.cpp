// SPDX-License-Identifier: BSD-3-Clause
// Parsing of measured plate tests, and errors in their files.
#include "runs/virtual_tests/measured_plates.hpp"

#include "base/error.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace grouser::virtual_tests::measured_plates {
namespace {

constexpr const char* kHead = "# two plates\ntrial,plate_diameter_mm,sinkage_mm,pressure_kPa\n";

class MeasuredPlatesTest : public test::FolderTest {
protected:
  std::vector<MeasuredPlate> read(const std::string& text, const std::vector<double>& sinkages) {
    std::ofstream(folder_ / "plates.csv") << text;
    return readMeasuredPlates(folder_ / "plates.csv", sinkages);
  }
  std::string errorOf(const std::string& text, const std::vector<double>& sinkages = {0.005}) {
    try {
      read(text, sinkages);
    } catch (const base::InputError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(MeasuredPlatesTest, InterpolatesEveryTestAndPoolsTheScatterOfSingleOnes) {
  // 3, 4 and 5 kPa at 5 mm: mean 4, standard deviation 1. The larger plate was tested once.
  const auto plates = read(std::string(kHead) + "1,60,0,0\n1,60,10,6\n2,60,0,0\n2,60,10,8\n3,60,0,0\n3,60,10,10\n"
                                                "4,100,0,1\n4,100,4,9\n4,100,8,13\n",
                           {0.005, 0.008});
  ASSERT_EQ(plates.size(), 2u);
  EXPECT_DOUBLE_EQ(plates[0].diameter, 0.06);
  ASSERT_EQ(plates[0].points.size(), 2u);
  const MeasuredPressure& small = plates[0].points[0];
  ASSERT_EQ(small.trials.size(), 3u);
  EXPECT_NEAR(small.trials[2].pressure, 5000, 1e-9);
  EXPECT_NEAR(small.mean, 4000, 1e-9);
  EXPECT_NEAR(small.deviation, 0.25, 1e-12);
  const MeasuredPressure& large = plates[1].points[0];
  ASSERT_EQ(large.trials.size(), 1u);
  EXPECT_NEAR(large.mean, 10000, 1e-9);
  EXPECT_NEAR(large.deviation, 0.25, 1e-12) << "root mean square of the repeated tests";
}

TEST_F(MeasuredPlatesTest, FindsWhereEachPlateFirstBearsTheContactPressure) {
  std::ofstream(folder_ / "plates.csv") << kHead << "1,60,0,0\n1,60,10,10\n2,60,0,-1\n2,60,6,2\n2,60,10,9\n"
                                        << "3,100,0.2,0.3\n3,100,0.6,0.7\n3,100,10,30\n";
  const auto plates = readMeasuredPlates(folder_ / "plates.csv", {0.005}, 500);
  EXPECT_NEAR(plates[0].contact, 0.5 * (0.0005 + 0.003), 1e-12) << "0.5 and 3 mm";
  EXPECT_NEAR(plates[1].contact, 0.0004, 1e-12);
  EXPECT_EQ(readMeasuredPlates(folder_ / "plates.csv", {0.005})[0].contact, 0) << "without a contact pressure";
  const std::pair<double, const char*> cases[] = {
      {2e4, "trial 1 never reaches plates.contact_pressure = 20000 Pa; choose a pressure between 0 and 10000 Pa"},
      {200, "trial 3 begins above plates.contact_pressure = 200 Pa; choose a pressure between 300 and 30000 Pa"}};
  for (const auto& [pressure, message] : cases) try {
      readMeasuredPlates(folder_ / "plates.csv", {0.005}, pressure);
      FAIL() << message;
    } catch (const base::InputError& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
}

TEST_F(MeasuredPlatesTest, LeavesOutWhatATestDoesNotReach) {
  const auto plates =
      read(std::string(kHead) + "1,60,0,0\n1,60,10,6\n2,60,0,0\n2,60,6,5\n4,100,0,1\n4,100,4,9\n", {0.003, 0.008});
  ASSERT_EQ(plates.size(), 2u);
  EXPECT_EQ(plates[0].points[1].trials.size(), 1u);
  EXPECT_EQ(plates[1].points.size(), 1u);
  EXPECT_DOUBLE_EQ(plates[1].deepest(), 0.003);
}

TEST_F(MeasuredPlatesTest, NamesLineColumnAndRemedy) {
  const std::string head = kHead;
  const std::pair<std::string, const char*> cases[] = {
      {"", "the file is empty"},
      {"trial,plate_diameter_mm,sinkage_mm\n1,60,0\n", "column pressure_kPa is missing"},
      {head, "no rows after"},
      {head + "1,60,five,2\n", "plates.csv:3: sinkage_mm = \"five\" is not a number"},
      {head + "1,60,5\n", "pressure_kPa = \"\" is not a number"},
      {head + "1.5,60,0,0\n", "whole number"},
      {head + "1,-60,0,0\n", "outside (0, 10000]"},
      {head + "1,60,0,0\n1,80,9,9\n", "use a different trial number for each test"},
      {head + "1,60,0,0\n1,60,4,9\n", "no test reaches a sinkage of 5 mm; remove it"},
      {head + "1,60,0,0\n1,60,9,-9\n", "is -5 kPa at a sinkage of 5 mm"},
      {head + "1,60,0,nan\n", "is not a number"}};
  for (const auto& [text, message] : cases)
    EXPECT_NE(errorOf(text).find(message), std::string::npos) << text << "\n" << errorOf(text);
  try {
    readMeasuredPlates(folder_ / "none.csv", {0.005});
    FAIL();
  } catch (const base::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("none.csv: no such file; correct plates.file"), std::string::npos) << e.what();
  }
}

} // namespace
} // namespace grouser::virtual_tests::measured_plates

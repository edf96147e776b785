// SPDX-License-Identifier: BSD-3-Clause
// Measured curves as calibration targets: parsing, input errors, and the definition of a residual.
#include "runs/virtual_tests/calibration.hpp"

#include "base/error.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>

namespace grouser::virtual_tests::curve_targets {
namespace {

constexpr const char* kTargets = "version = 1\n[targets]\nrepose = 29\nbulk_density = 1330\n";
constexpr const char* kPlates = "[plates]\nfile = \"plates.csv\"\nsinkages = [0.005, 0.01]\nbin = 0.2\ndepth = 0.1\n";
constexpr const char* kSearch = "[search]\nfriction = [0.3, 0.8]\nporosity = [0.4, 0.5]\ndepth = [0.05, 0.2]\n";
constexpr const char* kStart = "[start]\nlaw = \"hertz\"\nyoung = 1e8\nfriction = 0.5\n[bed]\ngrain_radius = "
                               "0.002\nporosity = 0.45\n";

class CurveTargetsTest : public test::FolderTest {
protected:
  CalibrationTargets read(const std::string& text) {
    std::ofstream(folder_ / "plates.csv")
        << "trial,plate_diameter_mm,sinkage_mm,pressure_kPa\n1,60,0,0\n1,60,12,12\n2,60,0,0\n2,60,12,14.4\n";
    std::ofstream(folder_ / "sand.toml") << text;
    return readTargets(folder_ / "sand.toml", 0);
  }
  std::string errorOf(const std::string& text) {
    try {
      read(text);
    } catch (const base::InputError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(CurveTargetsTest, ReadsPlatesSearchAndStart) {
  const CalibrationTargets t = read(std::string(kTargets) + kPlates + kSearch + kStart);
  ASSERT_TRUE(t.curves);
  EXPECT_EQ(t.curves->repose, 29);
  EXPECT_EQ(t.curves->bulkDensity, 1330);
  ASSERT_EQ(t.curves->plates.size(), 1u);
  ASSERT_EQ(t.curves->ranges.size(), 3u);
  EXPECT_EQ(t.curves->ranges[2].key, "depth");
  EXPECT_FALSE(t.curves->ranges[0].isLogarithmic);
  EXPECT_EQ(t.curves->contactPressure, 0);
  EXPECT_EQ(
      read(std::string(kTargets) + kPlates + "contact_pressure = 50\n" + kSearch + kStart).curves->contactPressure, 50);
  const MeasuredPlatesBed bed = t.curves->bed(0.15);
  EXPECT_EQ(bed.depth, 0.15);
  EXPECT_NEAR(bed.sinkages[0], 1.15 * 0.01, 1e-12) << "15 % deeper than the last point";
}

TEST_F(CurveTargetsTest, RefusesWhatDoesNotFit) {
  const std::string targets = kTargets, plates = kPlates, search = kSearch, start = kStart;
  const std::pair<std::string, const char*> cases[] = {
      {targets + plates + start, "search"},
      {targets + "phi = 30\n" + plates + search + start, "mutually exclusive with [plates]"},
      {targets + search + start, "repose = 29 requires [plates]"},
      {"version = 1\n[targets]\nphi = 30\n" + search + start, "requires [plates]"},
      {"version = 1\n[targets]\nphi = 30\nbulk_density = 1500\n" + start, "requires [plates]"},
      {targets + plates + "[search]\ntrials = 4\n" + start, "contains no parameters"},
      {targets + plates + "[search]\nfriction = [0.8, 0.3]\n" + start, "must be [min, max]"},
      {targets + plates + "[search]\nfriction = [0.6, 0.9]\n" + start, "does not include the initial value 0.5"},
      {targets + plates + "[search]\nstiffness = [1e4, 1e6]\n" + start, "has no initial value"},
      {targets + plates + "[search]\nfriction = [0.3, 0.8]\ntrials = 0\n" + start, "trials"},
      {targets + "[plates]\nfile = \"plates.csv\"\nsinkages = []\n" + search + start, "is empty"},
      {targets + "[plates]\nfile = \"plates.csv\"\nsinkages = [0.01, 0.005]\n" + search + start, "not ascending"},
      {targets + plates + "contact_pressure = 9000\n" + search + start,
       "at a sinkage of 8.25 mm, but the first comparison starts at 4 mm"},
      {targets + "[plates]\nfile = \"other.csv\"\nsinkages = [0.01]\n" + search + start, "no such file"},
      {targets + plates + search + "[start]\nfriction = 0.5\n[bed]\ngrain_radius = 0.002\n", "has no initial value"},
      {targets + plates + "[search]\nfriction = [0.3, 0.8]\n[start]\nfriction = 0.5\n[bed]\ngrain_radius = 0.002\n",
       "requires bed.porosity"}};
  for (const auto& [text, message] : cases)
    EXPECT_NE(errorOf(text).find(message), std::string::npos) << text << "\n" << errorOf(text);
}

TEST_F(CurveTargetsTest, APlateHasToFitItsBed) {
  const CalibrationTargets t = read(std::string(kTargets) + kPlates + kSearch + kStart);
  PlanOptions options;
  options.plates = t.curves->bed(0.1);
  EXPECT_NO_THROW(planOf(t.start, options));
  options.plates.bin = 0.1;
  EXPECT_THROW(planOf(t.start, options), base::InputError);
  options.plates.bin = 0.2, options.plates.depth = 0.015;
  EXPECT_THROW(planOf(t.start, options), base::InputError);
}

TEST(CurveResiduals, AreLogarithmsOverTheScatterAndTheAngleOverItsTolerance) {
  CurveTargets targets;
  targets.repose = 29, targets.reposeTolerance = 2;
  const MeasuredPressure scattered{0.01, {}, 10e3, 0.1}, exact{0.02, {}, 20e3, 0.01};
  const std::vector<CurvePoint> points{{0.06, scattered, {11e3, 500}}, {0.06, exact, {20e3, 500}}};
  const std::vector<double> r = curveResiduals(points, 27.0, targets);
  ASSERT_EQ(r.size(), 3u);
  EXPECT_NEAR(r[0], std::log(1.1) / 0.1, 1e-12);
  EXPECT_EQ(r[1], 0);
  EXPECT_EQ(r[2], -1);
  EXPECT_NEAR(points[0].deviations(), 1, 1e-12);
  const std::vector<CurvePoint> high{{0.06, exact, {22e3, 0}}};
  EXPECT_NEAR(curveResiduals(high, {}, targets)[0], std::log(1.1) / kMinScatter, 1e-12)
      << "the scatter of simulated beds is the least";
  EXPECT_NEAR(high[0].deviations(), 10, 1e-12) << "the table shows measured standard deviations";
}

TEST(ComparedCurve, CountsSinkageFromContactWhereAContactPressureIsGiven) {
  jobs::Table run;
  run.names = {"sinkage [m]", "pressure [Pa]"};
  run.rows = {{-0.003, 20}, {-0.002, 120}, {0, 1000}, {0.004, 5000}};
  CurveTargets targets;
  MeasuredPlate plate;
  plate.contact = 0.0005;
  EXPECT_EQ(comparedCurve(run, targets, plate).sinkage, (std::vector<double>{-0.003, -0.002, 0, 0.004}));
  targets.contactPressure = 100;
  const SinkageCurve compared = comparedCurve(run, targets, plate);
  ASSERT_EQ(compared.sinkage.size(), 3u);
  EXPECT_NEAR(compared.sinkage[0], 0.0005, 1e-15) << "as deep as the tests, which bear as much there";
  EXPECT_NEAR(compared.sinkage[2], 0.0065, 1e-15);
  EXPECT_EQ(compared.pressure, (std::vector<double>{120, 1000, 5000}));
  targets.contactPressure = 1e5;
  EXPECT_TRUE(comparedCurve(run, targets, plate).sinkage.empty()) << "a plate that bears less than that";
}

TEST(CurveParameters, AreOfMaterialBedAndPlates) {
  SoilInBed bed;
  bed.soil.keys = {{"friction", "0.5"}, {"young", "1e8"}};
  setParameter(bed, "porosity", 0.47), setParameter(bed, "depth", 0.07), setParameter(bed, "friction", 0.4);
  EXPECT_EQ(bed.soil.porosity, 0.47);
  EXPECT_EQ(bed.depth, 0.07);
  EXPECT_EQ(parameterOf(bed, "friction"), 0.4);
  EXPECT_EQ(bed.soil.friction, 0.4);
  EXPECT_EQ(parameterOf(bed, "rolling_friction"), 0);
  EXPECT_TRUE(std::isnan(parameterOf(bed, "stiffness")));
  CurveTargets targets;
  targets.ranges = {{"young", 1e6, 1e9, true}, {"porosity", 0.4, 0.5, false}}, targets.bulkDensity = 1500;
  setParameters(bed, targets, {2e8, 0.4});
  EXPECT_EQ(parameterOf(bed, "young"), 2e8);
  EXPECT_EQ(bed.soil.density, 2500) << "the solid fills 0.6 of the bed";
}

} // namespace
} // namespace grouser::virtual_tests::curve_targets

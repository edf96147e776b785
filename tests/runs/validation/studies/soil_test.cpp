// SPDX-License-Identifier: BSD-3-Clause
// Post-processing of the virtual soil tests against published values and closed forms, and small samples.
#include "base/error.hpp"
#include "base/math.hpp"
#include "base/sphere.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/validation/studies/plates_report.hpp"
#include "runs/validation/studies/shear_angle.hpp"
#include "runs/virtual_tests/soil_bed.hpp"
#include "terrain/random_bed.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <thread>

namespace grouser::studies {

using namespace test; // fixtures

namespace {

double radians(double degrees) { return degrees * base::kPi / 180; }

TEST(Bearing, FactorsAreThoseOfVesicsTable) {
  // Vesic 1973, table 1: angle [deg], N_c, N_q, N_gamma, to two decimals.
  const std::array<std::array<double, 4>, 5> published{{{0, 5.14, 1.00, 0.00},
                                                        {20, 14.83, 6.40, 5.39},
                                                        {25, 20.72, 10.66, 10.88},
                                                        {30, 30.14, 18.40, 22.40},
                                                        {40, 75.31, 64.20, 109.41}}};
  for (const auto& [angle, nc, nq, ngamma] : published) {
    const virtual_tests::BearingFactors f = virtual_tests::bearingFactors(radians(angle));
    EXPECT_NEAR(f.nc, nc, 0.0051) << angle;
    EXPECT_NEAR(f.nq, nq, 0.0051) << angle;
    EXPECT_NEAR(f.ngamma, ngamma, 0.0051) << angle;
  }
}

TEST(Bearing, PressureIsTerzaghisSumAndItsAngleIsFoundAgain) {
  const double weight = 15e3, b = 0.28, z = 0.05;
  // By hand from the table: 15000 (0.05 18.40 + 0.14 22.40); a circle with 1 + tan 30 deg = 1.577 and 0.6.
  EXPECT_NEAR(virtual_tests::bearingPressure(virtual_tests::PlateShape::strip, radians(30), weight, b, z), 60840, 15);
  EXPECT_NEAR(virtual_tests::bearingPressure(virtual_tests::PlateShape::circular, radians(30), weight, b, z), 49990,
              15);
  for (const virtual_tests::PlateShape shape :
       {virtual_tests::PlateShape::strip, virtual_tests::PlateShape::circular}) {
    const double q = virtual_tests::bearingPressure(shape, radians(27.5), weight, b, z);
    EXPECT_NEAR(virtual_tests::bearingAngle(shape, q, weight, b, z), radians(27.5),
                1e-9); // bisection to 2^-60 of 60 deg
  }
  // Linear in the sinkage: the mean over a slice is the value in its middle.
  EXPECT_NEAR(virtual_tests::meanBearing(virtual_tests::PlateShape::strip, radians(30), weight, b, 0.02, 0.08),
              virtual_tests::bearingPressure(virtual_tests::PlateShape::strip, radians(30), weight, b, z), 1e-6);
}

TEST(StudyBed, RestIsThatOfThreeLooksOrTheTimeIsUp) {
  // A grain falls 20 mm onto a plane, and bounces for ever or hardly once.
  const auto restOf = [](double restitution, double limit) {
    const std::string text =
        fmt::format("version = 1\n[run]\nduration = 9\ntime_step = 5e-5\n[material.ball]\ndensity = 2500\n"
                    "stiffness = 1e5\nrestitution = {}\n[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = "
                    "\"ball\"\n[[grain]]\nposition = [0, 0, 0.03]\nradius = 0.01\nmaterial = \"ball\"\n",
                    restitution);
    coupling::Simulation run(setup::simulationSetup(setup::parseScene(text, "scene.toml")), base::cpuExec(1),
                             [](double, double) {});
    const double m = base::sphereMass(2500, 0.01);
    const double left = virtual_tests::comeToRest(run, 1e-4 * m * 9.81 * 0.01, limit);
    return std::pair{left, run.time()};
  };
  const auto [calm, until] = restOf(0.1, 5);
  EXPECT_LT(calm, 1);
  EXPECT_LT(until, 1);
  const auto [restless, end] = restOf(1, 0.5);
  EXPECT_GT(restless, 1e3) << "in units of 2 m g r, at one of three checks";
  EXPECT_NEAR(end, 0.5, 0.03);
  EXPECT_GT(restOf(0.1, 0.03).first, 1) << "two checks are not enough";
  try {
    virtual_tests::failRestless(7, 6.3, 2e-3);
    FAIL();
  } catch (const base::SimulationError& e) { // only this test is left out: exit code 3
    EXPECT_NE(std::string(e.what()).find("seed 7 did not come to rest within 6.3 s: the mean kinetic energy per "
                                         "grain is still 0.002"),
              std::string::npos)
        << e.what();
  }
}

TEST(StudyEstimate, IntervalsAreStudents) {
  // Mean 3, standard deviation sqrt(2.5), five values: half width 2.776 sqrt(2.5 / 5).
  const std::vector<double> five{1, 2, 3, 4, 5};
  EXPECT_NEAR(jobs::interval95(five).halfWidth, 2.776 * std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(std::isinf(jobs::interval95(std::vector<double>{7}).halfWidth));
  // Equal variances and sizes: Welch's freedom is 2 (n - 1) = 8, with the quantile 2.306.
  const std::vector<double> more{2, 3, 4, 5, 6};
  const support::Estimate difference = jobs::relativeDifference(five, more);
  EXPECT_NEAR(difference.value, 1.0 / 3, 1e-12);
  EXPECT_NEAR(difference.halfWidth, 2.306 * std::sqrt(1.0) / 3, 1e-12);
  // One without scatter: the degrees of freedom are the other's, 4.
  const std::vector<double> same{3, 3, 3, 3, 3};
  EXPECT_NEAR(jobs::relativeDifference(same, five).halfWidth, 2.776 * std::sqrt(0.5) / 3, 1e-12);
}

TEST(StudyEstimate, AWideIntervalIsNeverAgreement) {
  EXPECT_EQ(jobs::judge({0.01, 0.03}, 0.05), jobs::Verdict::equal);
  EXPECT_EQ(jobs::judge({0.00, 0.06}, 0.05), jobs::Verdict::inconclusive);
  EXPECT_EQ(jobs::judge({0.04, 0.02}, 0.05), jobs::Verdict::inconclusive);
  EXPECT_EQ(jobs::judge({-0.10, 0.04}, 0.05), jobs::Verdict::differs);
  EXPECT_EQ(jobs::judge(jobs::interval95(std::vector<double>{0.0}), 0.05), jobs::Verdict::inconclusive)
      << "one seed has no interval";
}

TEST(ShearAngleFit, LineThroughTheStressesOfEachSeed) {
  // Two soils: tau = 100 Pa + sigma tan 25 deg, and the same at 27 deg without cohesion.
  std::vector<std::vector<virtual_tests::ShearStrength>> runs(2);
  for (const double sigma : {10e3, 30e3, 60e3}) {
    for (int k = 0; k < 2; ++k) {
      virtual_tests::ShearStrength s;
      s.normal = sigma, s.shear = (k == 0 ? 100 : 0) + sigma * std::tan(radians(25 + 2 * k));
      s.residual = s.shear / sigma, s.peak = 1.1 * s.residual, s.mohrCoulomb = radians(26 + 2 * k);
      runs[static_cast<std::size_t>(k)].push_back(s);
    }
  }
  const ShearAngle a = shearAngle(runs);
  EXPECT_NEAR(a.angle.value, 26, 1e-9);
  EXPECT_NEAR(a.angle.halfWidth, 12.706 * 1, 1e-6); // standard error of 25 and 27: 1
  EXPECT_NEAR(a.cohesion.value, 50, 1e-6);
  EXPECT_NEAR(a.mohrCoulomb.value, 27, 1e-9);
  EXPECT_GT(a.peakAngle.value, a.angle.value);
}

TEST(ShearAngleFit, MohrsCircle) {
  // Principal stresses 3 and 1 in any direction: sin phi = 1/2.
  EXPECT_NEAR(virtual_tests::mohrCoulombAngle(3, 1, 0), radians(30), 1e-12);
  EXPECT_NEAR(virtual_tests::mohrCoulombAngle(2, 2, 1), radians(30), 1e-12);
  EXPECT_EQ(virtual_tests::mohrCoulombAngle(2, 2, 0), 0);
}

TEST(ShearAngleFit, PeakAndResidualOfARun) {
  jobs::Table run;
  run.names = virtual_tests::kShearColumns;
  for (int k = 0; k <= 100; ++k) {
    const double ratio = k < 40 ? 0.01 * k : k < 50 ? 0.45 : 0.3;
    run.rows.push_back({0.004 * k, 1000 * ratio, 1000, 10, 1200, 1000, 1000 * ratio, 1000 * ratio, 0.4, 5, 5e-4, 1});
  }
  const virtual_tests::ShearStrength s = virtual_tests::shearStrength(run);
  EXPECT_NEAR(s.residual, 0.3, 1e-12);
  EXPECT_NEAR(s.peak, 0.45, 1e-12) << "mean over a twentieth of the strain";
  EXPECT_NEAR(s.mohrCoulomb, std::asin(std::hypot(0.1, 0.3) / 1.1), 1e-12);
}

class SoilSample : public FolderTest {};

/// Soft grains allow long steps.
virtual_tests::Soil softSoil() {
  virtual_tests::Soil soil;
  soil.grains.stiffness = 1e4, soil.grains.restitution = 0.3;
  return soil;
}

TEST_F(SoilSample, StressFromContactsIsThatOnThePlates) {
  virtual_tests::ShearCell cell;
  cell.length = 8, cell.width = 6, cell.depth = 7, cell.inertialNumber = 1e-2, cell.strain = 0.06, cell.rows = 10;
  const jobs::Table run = virtual_tests::shearCell(softSoil(), cell, 1000, 1, folder_, base::cpuExec(1));
  ASSERT_EQ(run.rows.size(), 11u);
  const auto mean = [&](const char* column) { // single rows scatter by 5 %
    const std::vector<double> all = run.values(column);
    return std::accumulate(all.end() - 5, all.end(), 0.0) / 5;
  };
  const double plates = mean("normal stress [Pa]");
  EXPECT_NEAR(plates, 1000, 30) << "the load, within the effect of vibration";
  // Tolerance of a tenth: vibration and dashpots, which the contact springs exclude, and 6 layers of grains.
  EXPECT_NEAR(mean("core zz [Pa]"), plates, 0.1 * plates);
  EXPECT_NEAR(mean("core xz [Pa]"), mean("shear stress [Pa]"), 0.1 * plates);
  const virtual_tests::ShearStrength s = virtual_tests::shearStrength(run);
  EXPECT_GT(s.residual, 0.15);
  EXPECT_LT(s.residual, 0.6);
  EXPECT_GT(s.porosityBefore, 0.36);
  EXPECT_LT(s.porosityBefore, 0.46);
}

/// The poured sample does not depend on the load: it is cached, without effect on results.
TEST_F(SoilSample, WhatIsPouredIsKeptForOtherLoads) {
  virtual_tests::ShearCell cell;
  cell.length = 6, cell.width = 5, cell.depth = 5, cell.inertialNumber = 5e-2, cell.strain = 0.04, cell.rows = 4;
  const std::filesystem::path one = folder_ / "one", other = folder_ / "other", kept = folder_ / "kept";
  for (const std::filesystem::path& folder : {one, other, kept}) std::filesystem::create_directories(folder);
  const auto run = [&](const std::filesystem::path& folder, double stress, const std::filesystem::path& where) {
    return virtual_tests::shearCell(softSoil(), cell, stress, 3, folder, base::cpuExec(1), where).rows;
  };
  const auto poured = [&] {
    return std::distance(std::filesystem::directory_iterator(kept), std::filesystem::directory_iterator());
  };
  run(one, 16000, kept); // a larger load is reached sooner
  EXPECT_EQ(poured(), 1);
  const std::filesystem::path file = std::filesystem::directory_iterator(kept)->path();
  const auto written = std::filesystem::last_write_time(file);
  const auto second = run(one, 32000, kept);
  EXPECT_EQ(poured(), 1);
  EXPECT_EQ(std::filesystem::last_write_time(file), written);
  EXPECT_EQ(second, run(other, 32000, other)) << "poured again";
  cell.tooth = 0.9;
  run(one, 32000, kept);
  EXPECT_EQ(poured(), 2) << "with other teeth";
  cell.tooth = virtual_tests::ShearCell().tooth;
  for (const char* damage : {"0.1 0.1 nowhere 0.01\n", "0.1 0.1 0.1 0.01\n"}) {
    put(file, damage);
    EXPECT_EQ(run(one, 32000, kept), second) << "poured again";
  }
  virtual_tests::removePoured(kept);
  EXPECT_EQ(poured(), 0);
}

/// Grains of 10 mm with an adhesion of 0.47 N: strength 0.75 w / r = 4.5 kPa (Rumpf 1962) beside the load of 1 kPa.
/// Sheared between teeth pressed in, or placed on top: means over `seeds` samples.
virtual_tests::ShearStrength stickingLayer(bool pressesIn, int seeds, const std::filesystem::path& folder) {
  virtual_tests::ShearCell cell;
  cell.length = 6, cell.width = 5, cell.depth = 7, cell.inertialNumber = 2e-2, cell.strain = 0.12, cell.rows = 20;
  cell.core = false, cell.tooth = 1.2, cell.tip = 0.4, cell.pressesIn = pressesIn;
  const double stress = 1000, w = 30; // [Pa], [J/m2]
  virtual_tests::Soil soil = softSoil();
  soil.preparationLaw = "stiffness = 1e4\nrestitution = 0.3\n";
  soil.grains.law = soil.preparationLaw + fmt::format("cohesion = {}\n", w);
  virtual_tests::ShearStrength mean;
  for (int seed = 1; seed <= seeds; ++seed) {
    const virtual_tests::ShearStrength one =
        virtual_tests::shearStrength(virtual_tests::shearCell(soil, cell, stress, seed, folder, base::cpuExec(1)));
    mean.residual += one.residual / seeds, mean.sheared += one.sheared / seeds;
  }
  std::printf("%s: tau/sigma %.2f, sheared %.2f\n", pressesIn ? "pressed in" : "upon", mean.residual, mean.sheared);
  return mean;
}

/// A single sample scatters: checks only which value is larger.
TEST_F(SoilSample, OneThatSticksIsShearedMoreWhereTeethArePressedIn) {
  const virtual_tests::ShearStrength in = stickingLayer(true, 1, folder_), upon = stickingLayer(false, 1, folder_);
  EXPECT_GT(in.sheared, upon.sheared);
  EXPECT_GT(in.residual, upon.residual);
}

TEST_F(SoilSample, ALayerThatSticksIsShearedItself) {
  const virtual_tests::ShearStrength in = stickingLayer(true, 3, folder_), upon = stickingLayer(false, 3, folder_);
  EXPECT_GT(in.sheared, 0.5) << "share of the travel";
  EXPECT_LT(upon.sheared, 0.35) << "it slides along the teeth";
  EXPECT_GT(in.residual, 1.5 * upon.residual) << "the measured value is the strength at the teeth";
}

TEST_F(SoilSample, LessPreparationFrictionMakesADenserBed) {
  virtual_tests::Soil rough = softSoil(), smooth = softSoil();
  smooth.preparationFriction = 0;
  const virtual_tests::BedSize size{0.07, 0.07, 0.08};
  const std::string floor = "[[plane]]\nmaterial = \"grain\"\n";
  const auto solid = [&](const virtual_tests::Soil& soil) {
    const virtual_tests::BedGrains bed = virtual_tests::pourBed(soil, size, floor, 1, folder_, base::cpuExec(1));
    return virtual_tests::solidFraction(bed, size, 0.02, virtual_tests::surfaceHeight(bed, size, 0.01) - 0.02);
  };
  // Poured spheres of these radii: porosity for a friction of 0.5, and 0.64 solid without.
  EXPECT_NEAR(solid(rough), 0.595, 0.025);
  EXPECT_GT(solid(smooth), solid(rough) + 0.02);
}

TEST_F(SoilSample, PlateFeelsTheBedOnlyOnceItTouches) {
  virtual_tests::PlateTest test;
  test.floor = virtual_tests::BedFloor::rough, test.breadth = 4, test.bin = 3, test.depth = 1.5, test.thickness = 6;
  test.sinkage = 0.25, test.inertialNumber = 3e-2, test.rows = 40;
  double done = 0;
  const jobs::Table run =
      virtual_tests::pushPlate(softSoil(), test, 1, folder_, base::cpuExec(1), [&](double share, const std::string&) {
        EXPECT_GE(share, done);
        done = share;
      });
  EXPECT_DOUBLE_EQ(done, 1);
  ASSERT_EQ(run.rows.size(), 40u);
  EXPECT_GT(run.values("bed's steps").back(), 1000) << "two lifts fall and come to rest";
  const double b = 0.04;
  EXPECT_NEAR(run.values("sinkage [m]").back(), test.sinkage * b, 0.03 * test.sinkage * b);
  const double area = test.area(softSoil());
  EXPECT_NEAR(area, 0.04 * 0.06, 1e-12);
  // A small plate on soft grains has few or many contacts by chance: compares means over most of its travel.
  const double first = run.values("force [N]").front() / area,
               mean = virtual_tests::meanPressure(run, area, 0.05 * b, 0.25 * b);
  EXPECT_GT(mean, 3 * first);
  // Theory at 15 and 45 degrees, far below and above any bed of spheres.
  EXPECT_GT(mean, virtual_tests::bearingPressure(virtual_tests::PlateShape::strip, radians(15), 14e3, b, 0.15 * b));
  EXPECT_LT(mean, virtual_tests::bearingPressure(virtual_tests::PlateShape::strip, radians(45), 14e3, b, 0.15 * b));
}

const auto kSilent = [](const std::string&) {};

/// Coarser with depth: 9 cm deep, spheres of 10 mm at the top and 16 mm at the bottom.
virtual_tests::BedPreparation gradedBed() {
  virtual_tests::BedPreparation bed;
  bed.size = {0.07, 0.07, 0.09}, bed.lift = 0.045;
  bed.grading = {0.02, 0.12, 0.008};
  return bed;
}

TEST_F(SoilSample, GradedBedIsFineAboveAndCoarseBelow) {
  const virtual_tests::Soil soil = softSoil();
  const virtual_tests::BedPreparation bed = gradedBed();
  const virtual_tests::PreparedBed made = virtual_tests::prepareBed(soil, bed, 1, folder_, base::cpuExec(1), kSilent);
  EXPECT_NEAR(virtual_tests::surfaceHeight(made.grains, bed.size, 0.01), 0.09, 0.01)
      << "within a grain of the requested depth";
  double above = 0, below = 0;
  int countAbove = 0, countBelow = 0;
  for (const virtual_tests::BedGrain& g : made.grains) {
    if (g.position.z > 0.07) above += g.radius, ++countAbove;
    if (g.position.z < 0.03) below += g.radius, ++countBelow;
  }
  // 5 mm, and their maximum growth. Pouring mixes neighbouring depths, and few grains scatter.
  EXPECT_NEAR(above / countAbove, 0.005, 0.001);
  EXPECT_NEAR(below / countBelow, 0.008, 0.001);
}

TEST_F(SoilSample, KeptBedIsTakenUpWithTheSameBits) {
  const virtual_tests::Soil soil = softSoil();
  const virtual_tests::BedPreparation bed = gradedBed();
  const virtual_tests::PreparedBed first = virtual_tests::keptBed(soil, bed, 1, folder_, base::cpuExec(1), kSilent);
  const virtual_tests::PreparedBed again =
      virtual_tests::keptBed(soil, bed, 1, folder_, base::cpuExec(1),
                             [](const std::string& phase) { ADD_FAILURE() << "prepared again: " << phase; });
  EXPECT_EQ(again.steps, first.steps);
  EXPECT_GT(again.steps, 0);
  ASSERT_EQ(again.grains.size(), first.grains.size());
  for (std::size_t k = 0; k < first.grains.size(); ++k) {
    EXPECT_EQ(again.grains[k].position, first.grains[k].position);
    EXPECT_EQ(again.grains[k].radius, first.grains[k].radius);
  }
}

TEST(Lifts, AreAsThickInADeeperBed) {
  virtual_tests::BedPreparation bed;
  bed.size = {1, 1, 0.24}, bed.lift = 0.12;
  EXPECT_EQ(virtual_tests::liftTops(bed), (std::vector<double>{0.12, 0.24}));
  bed.size.depth = 0.48;
  EXPECT_EQ(virtual_tests::liftTops(bed), (std::vector<double>{0.12, 0.24, 0.36, 0.48}));
  bed.lift = 0;
  EXPECT_EQ(virtual_tests::liftTops(bed), (std::vector<double>{0.48}));
}

/// Grains small enough to fall through the fixed ones, without ever coming to rest.
TEST(PlateBed, WhatFindsAHoleInTheFloorIsCaught) {
  virtual_tests::Soil soil;
  virtual_tests::BedPreparation bed;
  bed.floor = virtual_tests::BedFloor::fixed;
  bed.size = {8 * soil.grains.diameter(), 8 * soil.grains.diameter(), 4 * soil.grains.diameter()};
  const double small = 0.2 * soil.grains.radius;
  std::string text = soil.scene(1, 1, 0, {0, 0, -9.81}, bed.size.run()) + virtual_tests::floorSections(soil, bed, 1);
  for (int k = 0; k < 16; ++k)
    text += fmt::format("[[grain]]\nposition = [{}, {}, {}]\nradius = {}\nmaterial = \"grain\"\n",
                        (k % 4 + 0.5) * bed.size.length / 4, (k / 4 + 0.5) * bed.size.width / 4,
                        1.5 * soil.grains.diameter(), small);
  coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, "holes.toml")), base::cpuExec(1),
                                  [](double, double) {});
  for (auto left = static_cast<std::int64_t>(0.15 / simulation.timeStep()); left > 0;) left -= simulation.advance(left);
  double lowest = 0;
  for (const virtual_tests::BedGrain& g : virtual_tests::grainsOf(simulation, bed.size))
    lowest = std::min(lowest, g.position.z);
  EXPECT_LT(lowest, -1.2 * soil.grains.diameter()) << "no grain fell through a hole";
  EXPECT_GT(lowest, -1.5 * soil.grains.diameter());
}

TEST(PlateCases, DoublingChangesOneThing) {
  PlatesCommand command;
  const std::vector<PlateCase> all = plateCases(command);
  ASSERT_EQ(all.size(), 8u);
  const virtual_tests::Soil soil;
  const virtual_tests::BedSize base = all[0].test.bed(soil);
  EXPECT_EQ(all[0].test.floor, virtual_tests::BedFloor::fixed);
  EXPECT_EQ(all[1].test.floor, virtual_tests::BedFloor::rough);
  EXPECT_DOUBLE_EQ(all[2].test.bed(soil).depth, 2 * base.depth);
  EXPECT_DOUBLE_EQ(all[2].test.bed(soil).length, base.length);
  EXPECT_DOUBLE_EQ(all[3].test.bed(soil).length, 2 * base.length);
  EXPECT_DOUBLE_EQ(all[3].test.bed(soil).depth, base.depth);
  command.cases = {"deep", "nonsense"};
  EXPECT_THROW(plateCases(command), base::InputError);
}

TEST(PlateCases, GradedBedHasAFifthOfTheGrains) {
  const std::vector<PlateCase> all = plateCases({});
  const virtual_tests::PlateTest &fine = all[6].test, &graded = all[7].test;
  ASSERT_EQ(all[6].name, "fine");
  ASSERT_EQ(all[7].comparedWith, "fine");
  const virtual_tests::Soil soil;
  const auto grains = [&](const virtual_tests::PlateTest& test) {
    const virtual_tests::BedPreparation p = test.preparation(soil);
    terrain::RandomBedOptions o;
    o.radii = {terrain::RadiusLaw::uniform, soil.grains.radius, soil.spread, {}, {}};
    o.grading = p.grading, o.depth = p.size.depth, o.roughFloor = true, o.periodic = {true, true};
    return static_cast<double>(
        terrain::planBed(terrain::HeightField::flat({0, p.size.length, 0, p.size.width}, p.size.depth), o).grains);
  };
  EXPECT_GT(grains(fine), 5 * grains(graded));
  const virtual_tests::BedPreparation p = graded.preparation(soil);
  EXPECT_EQ(virtual_tests::liftTops(p), virtual_tests::liftTops(fine.preparation(soil)));
  EXPECT_LE(2 * p.coarsest(soil) * soil.grains.radius * (1 + soil.spread), p.size.width / 3.5 * (1 + 1e-12));
  // Ten grains across, with the bed moving as deep as the strip.
  const double breadth = graded.breadth * soil.grains.diameter();
  EXPECT_LE(10 * p.grading.scaleAt(1.35 * breadth, soil.grains.radius) * soil.grains.diameter(), breadth);
  EXPECT_GT(graded.young, 0) << "with linear springs of equal stiffness coarse ground would be softer";
}

/// Four seeds of a case, with forces independent of the sinkage.
CaseRuns madeUp(const PlateCase& plate, double force, double grains, double seconds) {
  CaseRuns runs{&plate, 1, 1, {}};
  for (const double scatter : {-0.002, 0.002, -0.002, 0.002}) {
    jobs::Table table;
    table.names = virtual_tests::kPlateColumns;
    for (int k = 1; k <= 100; ++k)
      table.rows.push_back({0.003 * k, force * (1 + scatter), 0.4, grains, 1000, 0.5 * seconds, 2000, 0.5 * seconds});
    runs.runs.push_back(table);
  }
  return runs;
}

TEST(PlatePressure, OfASliceIsTheMeanOfItsRows) {
  jobs::Table run;
  run.names = virtual_tests::kPlateColumns;
  for (int k = 1; k <= 10; ++k) run.rows.push_back({0.01 * k, 100.0 * k, 0.4, 1, 1, 1, 1, 1});
  EXPECT_NEAR(virtual_tests::meanPressure(run, 0.5, 0.025, 0.055), 2 * 400, 1e-9) << "3, 4, 5";
  EXPECT_NEAR(virtual_tests::meanPressure(run, 0.5, 0, 1), 2 * 550, 1e-9);
  EXPECT_TRUE(std::isnan(virtual_tests::meanPressure(run, 0.5, 0.2, 0.3)));
}

TEST(PlateReport, GradedAgainstFine) {
  const std::vector<PlateCase> cases = plateCases({});
  const std::vector<Slice> slices = sinkageSlices(0.3);
  std::string csv;
  // Welch: variances of 1.333 permille^2 and 1.03^2 of that, five degrees of freedom: 2.571 sqrt(2.748) permille.
  const std::string equal =
      differenceTable({madeUp(cases[6], 100, 1000, 30), madeUp(cases[7], 103, 190, 10)}, slices, csv);
  EXPECT_NE(equal.find("graded to fine"), std::string::npos) << equal;
  EXPECT_NE(csv.find("graded,fine,0.075,0.3,0.03000,0.00426"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",equal\n"), std::string::npos) << csv;
  differenceTable({madeUp(cases[6], 100, 1000, 30), madeUp(cases[7], 108, 190, 10)}, slices, csv);
  EXPECT_NE(csv.find(",differs\n"), std::string::npos) << csv;
  EXPECT_EQ(differenceTable({madeUp(cases[7], 108, 190, 10)}, slices, csv), "") << "no case to compare with";

  const std::string costs = costTable({madeUp(cases[6], 100, 1000, 30), madeUp(cases[7], 103, 190, 10)}, csv);
  EXPECT_NE(costs.find("5.26 times fewer grains than fine, 3.00 times faster"), std::string::npos) << costs;
  EXPECT_NE(csv.find("graded,190,1000,5.00,2000,5.00,5.263,3.000\n"), std::string::npos) << csv;
}

TEST_F(SoilSample, NoRunIsBegunThatWouldNotEndInTime) {
  jobs::PieceOptions options;
  options.seconds = 60;
  jobs::Pieces pieces("test", {(folder_ / "pieces").string()}, options, {{"study", "test"}});
  const jobs::Table table{{"a"}, {{1}}};
  EXPECT_TRUE(pieces.due("long_seed1")) << "regardless of its duration";
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  pieces.keep("long_seed1", table);
  EXPECT_TRUE(pieces.due("long_seed2")) << "30 ms remain";

  options.seconds = 0.5, options.resume = true;
  jobs::Pieces hurried("test", {(folder_ / "pieces").string()}, options, {{"study", "test"}});
  EXPECT_FALSE(hurried.due("long_seed1")) << "it exists already";
  EXPECT_TRUE(hurried.due("short_seed1"));
  hurried.keep("short_seed1", table);
  EXPECT_TRUE(hurried.due("long_seed2"));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  hurried.keep("long_seed2", table);
  EXPECT_FALSE(hurried.due("long_seed3")) << "the last took 0.3 s, 0.2 s remain";
  EXPECT_FALSE(hurried.due("new_seed1")) << "for a new kind, the longest duration counts";
  EXPECT_TRUE(hurried.due("short_seed2"));
  EXPECT_EQ(hurried.left(), 2);
}

} // namespace
} // namespace grouser::studies

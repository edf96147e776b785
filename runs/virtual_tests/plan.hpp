// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/measured_plate.hpp"
#include "runs/virtual_tests/plate_sinkage.hpp"
#include "runs/virtual_tests/repose.hpp"
#include "runs/virtual_tests/shear_cell.hpp"
#include "runs/virtual_tests/shear_strength.hpp"
#include "runs/virtual_tests/tested_soil.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

/// Plan of the tests of a virtual bevameter: their sizes, loads and seeds.
namespace grouser::virtual_tests {

/// Reference track for pressures and breadths: pads 0.28 m wide, mean pressure 47.5 kPa.
inline constexpr double kTrackBreadth = 0.28, kTrackPressure = 47.5e3; ///< [m], [Pa]

/// Circular plates for comparison with measurements, and their bed, as in a scene's [terrain].
struct MeasuredPlatesBed {
  std::vector<double> diameters, sinkages; ///< [m] of the plates, and their final sinkages
  double bin = 0.3, depth = 0.12;          ///< [m] side of the square bed between periodic boundaries, and its depth
};

/// Options of the user; the defaults are the full settings (without --quick).
struct PlanOptions {
  bool coarse = false;                                        ///< --quick
  double plateGrains = 20;                                    ///< [d] breadth of the small plate
  double plateRatio = 3;                                      ///< breadth of the large plate / breadth of the small one
  double bin = 5, depth = 2;                                  ///< [breadths] width and depth of the bed
  double thickness = 12;                                      ///< [d] thickness of beds, along the strips
  double gradedThickness = 16;                                ///< [d] thickness of graded beds
  double inertialNumber = 1.8e-3, shearInertialNumber = 8e-4; ///< [-]
  double plateWaves = 0.04;                                   ///< pressure added by waves / pressure of the track [-]
  double stepsPerContact = 20;                                ///< steps per duration of the shortest contact
  double shearStrain = 0.4;                                   ///< [-]
  double shearHeight = 0.14;                                  ///< [m] height of a shear sample, at least ten grains
  std::vector<double> loads = {10e3, 25e3, 50e3, 100e3};      ///< [Pa] normal stresses of the shear tests
  double maxPressure = 100e3;                                 ///< [Pa] maximum pressure of the plates
  int seeds = 8, largeSeeds = 3;
  int reposeSeeds = 0;      ///< number of tilted beds
  MeasuredPlatesBed plates; ///< one test per plate and seed
  bool wide = true;         ///< also test the small plate on a bed of twice the width
};
/// Options of --quick.
PlanOptions coarsePlan();

enum class TestKind {
  small,
  large,
  wide,
  shear,
  repose,
  plate ///< a circular plate for comparison with a measured one
};

/// Factor by which the steps per contact increase when a failed test is repeated [-].
inline constexpr double kShorterSteps = 1.5;

/// One test of the plan.
struct PlannedTest {
  std::string name; ///< "small_seed1", "shear25kPa_seed3"; prefix "coarse_" in coarse plans
  TestKind kind{};
  double load = 0;     ///< [Pa] normal stress of a shear test
  double diameter = 0; ///< [m] diameter of a circular plate (TestKind::plate)
  int seed = 0;
  double cost = 0; ///< approximate number of grains x simulated time; determines the order and the remaining time
};

struct TestPlan {
  PlanOptions options;
  TestedSoil soil;
  Soil grains; ///< preparationFriction is set by doTests()
  PlateSinkage small, large, wide;
  ShearCell cell;
  ReposeTest repose;
  std::vector<PlannedTest> tests; ///< in the order in which a single process performs them

  const PlateSinkage& plate(TestKind kind) const;
  MeasuredPlateTest measuredPlate(double diameter) const; ///< [m]
  double breadth(TestKind kind) const;                    ///< [m]
  /// All parameters of the tests.
  nlohmann::ordered_json recipe() const;
  std::string care() const { return options.coarse ? "coarse" : "full"; }
  std::string preparationName() const { return options.coarse ? "coarse_preparation" : "preparation"; }
};
/// Throws InputError if a bed or sample is impossible.
TestPlan planOf(const TestedSoil& soil, const PlanOptions& options);

/// Stable sort by decreasing cost, so that no process is still busy with a long test after all others have finished.
void longestFirst(std::vector<const PlannedTest*>& tests);

/// Performs a test. `folder`: temporary files; `kept`: folder of poured samples, which the other loads reuse.
jobs::Table doTest(const TestPlan& plan, const PlannedTest& test, const std::filesystem::path& folder,
                   const std::filesystem::path& kept, const base::Exec& exec, const PlateProgress& report);

/// Curve of a shear test.
ShearCurve shearCurve(const jobs::Table& run, double diameter);

} // namespace grouser::virtual_tests

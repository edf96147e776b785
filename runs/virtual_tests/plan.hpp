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

/// Which tests a bevameter does, with grains of which size.
namespace grouser::virtual_tests {

/// The track that pressures and breadths are meant for: pads 0.28 m broad, 47.5 kPa in the mean.
inline constexpr double kTrackBreadth = 0.28, kTrackPressure = 47.5e3; ///< [m], [Pa]

/// Measured circular plates and the bed that each is pushed into, made as a scene's [terrain].
struct MeasuredPlatesBed {
  std::vector<double> diameters, sinkages; ///< [m] of the plates, and their final sinkages
  double bin = 0.3, depth = 0.12;          ///< [m] side of the square bed between periodic boundaries, and its depth
};

/// What a user may choose; the values are those of full care.
struct PlanOptions {
  bool coarse = false;                                        ///< --quick
  double plateGrains = 20;                                    ///< [d] breadth of the small plate
  double plateRatio = 3;                                      ///< breadth of the large one over that
  double bin = 5, depth = 2;                                  ///< [breadths] between the boundaries, and of the bed
  double thickness = 12;                                      ///< [d] of beds along the strips
  double gradedThickness = 16;                                ///< [d] of graded beds
  double inertialNumber = 1.8e-3, shearInertialNumber = 8e-4; ///< [-]
  double plateWaves = 0.04;                                   ///< of the track's pressure, that waves add to a plate's
  double stepsPerContact = 20;                                ///< of the shortest contact
  double shearStrain = 0.4;                                   ///< [-]
  double shearHeight = 0.14;                                  ///< [m] of a sheared sample, at least ten grains
  std::vector<double> loads = {10e3, 25e3, 50e3, 100e3};      ///< [Pa]
  double mostPressure = 100e3;                                ///< [Pa]
  int seeds = 8, largeSeeds = 3;
  int reposeSeeds = 0;      ///< beds that are tilted
  MeasuredPlatesBed plates; ///< one test of each for every seed
  bool wide = true;         ///< the small plate on a bin of twice the width, too
};
/// What --quick takes instead.
PlanOptions coarsePlan();

enum class TestKind {
  small,
  large,
  wide,
  shear,
  repose,
  plate ///< a measured circular plate
};

/// Times as many steps a contact, of a test that has ended unsoundly [-].
inline constexpr double kShorterSteps = 1.5;

/// One test of the plan: a piece of its own.
struct PlannedTest {
  std::string name; ///< "small_seed1", "shear25kPa_seed3"; in coarse plans with "coarse_" before it
  TestKind kind{};
  double load = 0;     ///< [Pa] of shear tests
  double diameter = 0; ///< [m] of measured plates
  int seed = 0;
  double cost = 0; ///< about grains times simulated time: for the time left, and for which go first
};

struct TestPlan {
  PlanOptions options;
  TestedSoil soil;
  Soil grains; ///< preparationFriction is found by preparationFriction()
  PlateSinkage small, large, wide;
  ShearCell cell;
  ReposeTest repose;
  std::vector<PlannedTest> tests; ///< seed by seed

  const PlateSinkage& plate(TestKind kind) const;
  MeasuredPlateTest measuredPlate(double diameter) const; ///< [m]
  double breadth(TestKind kind) const;                    ///< [m]
  /// All that the tests depend on.
  nlohmann::ordered_json recipe() const;
  std::string care() const { return options.coarse ? "coarse" : "full"; }
  std::string preparationName() const { return options.coarse ? "coarse_preparation" : "preparation"; }
};
/// Throws InputError where a bed cannot be.
TestPlan planOf(const TestedSoil& soil, const PlanOptions& options);

/// The longest first, of those that take as long in their order: so no process is left alone with a long one.
void longestFirst(std::vector<const PlannedTest*>& tests);

/// Does a test. `folder`: for files on the way; `kept`: where samples that are poured stay, for the other loads.
jobs::Table doTest(const TestPlan& plan, const PlannedTest& test, const std::filesystem::path& folder,
                   const std::filesystem::path& kept, const base::Exec& exec, const PlateProgress& tell);

/// The curve of a shear test.
ShearCurve shearCurve(const jobs::Table& run, double diameter);

} // namespace grouser::virtual_tests

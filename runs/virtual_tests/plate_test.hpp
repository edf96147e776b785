// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/bearing.hpp"
#include "runs/virtual_tests/plate_bed.hpp"

/// A rough rigid plate pushed down into a bed at constant speed.
namespace grouser::virtual_tests {

struct PlateTest {
  static constexpr double kOffEnds = 2; ///< [d] layer at the floor and at the surface excluded from the porosity
  PlateShape shape = PlateShape::strip; ///< a strip extends through both boundaries along y
  BedFloor floor = BedFloor::fixed;
  bool lattice = false;           ///< lattice of equal spheres instead of a rained bed
  double breadth = 12;            ///< [d] breadth of a strip along x, or diameter of a circular plate
  double bin = 8, depth = 2;      ///< [breadths] width along x and depth of the bed
  double thickness = 12;          ///< [d] of a strip's bed along y; beds of circular plates are square
  double fineDepth = 0;           ///< [breadths] depth down to which grains have their original size
  double coarsening = 0;          ///< [-] increase of the mean radius per depth below fineDepth; 0: no grading
  double young = 0;               ///< [Pa] above 0: Hertz contacts with this Young's modulus
  double sinkage = 0.3;           ///< [breadths] final sinkage below the surface
  double inertialNumber = 1.8e-3; ///< [-] (speed / breadth) d sqrt(density / expected pressure)
  int rows = 300;                 ///< rows of the table

  BedSize bed(const Soil& soil) const;
  BedPreparation preparation(const Soil& soil) const;
  double area(const Soil& soil) const;  ///< [m2]
  double speed(const Soil& soil) const; ///< [m/s]
};

/// Scene section of the plate, named "plate": lower face at `bottom` [m], moving down at `speed` [m/s].
std::string plateSection(const Soil& soil, const PlateTest& test, double bottom, double speed);
/// Top of the highest grain below the plate [m].
double topUnder(const Soil& soil, const PlateTest& test, const BedGrains& bed);

// Assumed soil properties, for the speed of plates only.
inline constexpr double kExpectedAngle = 24 * base::kPi / 180, kExpectedSolid = 0.59; ///< [rad], [-]
inline constexpr double kSlow = 0.1; ///< minimum impact speed for the time step of Hertz contacts [m/s]

/// Columns of a run's table; the values from the third column on are the same in all rows.
inline const std::vector<std::string> kPlateColumns = {
    "sinkage [m]", "force [N]",           "porosity [-]",  "grains",
    "bed's steps", "bed's wall time [s]", "plate's steps", "plate's wall time [s]"};

/// Receives the completed fraction [-] and the phase of a run.
using PlateProgress = std::function<void(double done, const std::string& phase)>;

/// Prepares a bed and pushes the plate into it. `folder`: temporary files; also bed.txt, which later calls reuse.
jobs::Table pushPlate(const Soil& soil, const PlateTest& test, std::int64_t seed, const std::filesystem::path& folder,
                      const base::Exec& exec, const PlateProgress& report);

/// Mean pressure of a run [Pa] between the sinkages `from` and `to` [m].
double meanPressure(const jobs::Table& run, double area, double from, double to);
/// Mean of bearingPressure() between the sinkages `from` and `to` [Pa].
double meanBearing(PlateShape shape, double angle, double unitWeight, double breadth, double from, double to);

} // namespace grouser::virtual_tests

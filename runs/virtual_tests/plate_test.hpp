// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/bearing.hpp"
#include "runs/virtual_tests/plate_bed.hpp"

/// A rough rigid plate pushed down into a bed at constant speed.
namespace grouser::virtual_tests {

struct PlateTest {
  static constexpr double kOffEnds = 2; ///< grains excluded at both ends for the porosity
  PlateShape shape = PlateShape::strip; ///< a strip extends through both boundaries along y
  BedFloor floor = BedFloor::fixed;
  bool lattice = false;           ///< lattice of equal spheres instead of a poured bed
  double breadth = 12;            ///< [d] of a strip along x; diameter of a circular plate
  double bin = 8, depth = 2;      ///< [breadths] width along x and depth of the bed
  double thickness = 12;          ///< [d] of a strip's bed along y; for a circular plate as along x
  double fineDepth = 0;           ///< [breadths] depth of the grains of original size
  double coarsening = 0;          ///< [-] growth of the mean radius with depth below that; 0: none
  double young = 0;               ///< [Pa] above 0: Hertz' contacts
  double sinkage = 0.3;           ///< [breadths] final sinkage below the surface
  double inertialNumber = 1.8e-3; ///< [-] speed over breadth times d sqrt(density / expected pressure)
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
inline constexpr double kSlow =
    0.1; ///< impact speed for the time step of Hertz' contacts, unless a plate is faster [m/s]

/// Columns of a run's table; constant from the third column.
inline const std::vector<std::string> kPlateColumns = {
    "sinkage [m]", "force [N]",           "porosity [-]",  "grains",
    "bed's steps", "bed's wall time [s]", "plate's steps", "plate's wall time [s]"};

/// Receives phase and completed share [-] of a run.
using PlateProgress = std::function<void(double done, const std::string& phase)>;

/// Prepares a bed and pushes the plate into it. `folder`: temporary files, and bed.txt with the bed, which is reused.
jobs::Table pushPlate(const Soil& soil, const PlateTest& test, std::int64_t seed, const std::filesystem::path& folder,
                      const base::Exec& exec, const PlateProgress& tell);

/// Mean pressure [Pa] between two sinkages [m].
double meanPressure(const jobs::Table& run, double area, double from, double to);
/// Theoretical mean over the same interval [Pa].
double meanBearing(PlateShape shape, double angle, double unitWeight, double breadth, double from, double to);

} // namespace grouser::virtual_tests

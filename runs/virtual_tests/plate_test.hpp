// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "runs/jobs/pieces.hpp"
#include "runs/virtual_tests/bearing.hpp"
#include "runs/virtual_tests/plate_bed.hpp"

/// A rough rigid plate pushed down into a bed at constant speed.
namespace grouser::virtual_tests {

struct PlateTest {
  static constexpr double kOffEnds = 2; ///< grains left out below and above where porosity is measured
  PlateShape shape = PlateShape::strip; ///< a strip reaches through both boundaries along y
  BedFloor floor = BedFloor::fixed;
  bool lattice = false;           ///< instead of a poured bed: equal spheres laid in a lattice
  double breadth = 12;            ///< [d] of a strip along x; diameter of a circular plate
  double bin = 8, depth = 2;      ///< [breadths] between the boundaries along x, and of the bed
  double thickness = 12;          ///< [d] of a strip's bed along y; beside a circular plate it is the bin's
  double fineDepth = 0;           ///< [breadths] down to which grains are as the soil's
  double coarsening = 0;          ///< [-] growth of the mean radius with depth below that; 0: none
  double young = 0;               ///< [Pa] above 0: Hertz' contacts
  double sinkage = 0.3;           ///< [breadths] below the bed's surface, to which the plate is pushed
  double inertialNumber = 1.8e-3; ///< [-] speed over breadth times d sqrt(density / pressure expected)
  int rows = 300;                 ///< of a table

  BedSize bed(const Soil& soil) const;
  BedPreparation preparation(const Soil& soil) const;
  double area(const Soil& soil) const;  ///< [m2]
  double speed(const Soil& soil) const; ///< [m/s]
};

/// The section of a scene with the plate, "plate": its face at height `bottom` [m], going down at `speed` [m/s].
std::string plateSection(const Soil& soil, const PlateTest& test, double bottom, double speed);
/// Highest top of the grains that the plate will meet first [m].
double topUnder(const Soil& soil, const PlateTest& test, const BedGrains& bed);

// For the speed of plates alone: what is expected of a soil before it is measured.
inline constexpr double kExpectedAngle = 24 * base::kPi / 180, kExpectedSolid = 0.59; ///< [rad], [-]
inline constexpr double kSlow = 0.1; ///< for the step of Hertz' contacts, unless a plate is faster [m/s]

/// Columns of a run's table; from the third on the same in all rows.
inline const std::vector<std::string> kPlateColumns = {
    "sinkage [m]", "force [N]",           "porosity [-]",  "grains",
    "bed's steps", "bed's wall time [s]", "plate's steps", "plate's wall time [s]"};

/// Hears what a run is at, and which share of it is done [-].
using PlateProgress = std::function<void(double done, const std::string& phase)>;

/// Prepares a bed and pushes the plate into it. `folder`: for files on the way; its bed.txt is the bed, which is taken
/// from there where an earlier call has left it.
jobs::Table pushPlate(const Soil& soil, const PlateTest& test, std::int64_t seed, const std::filesystem::path& folder,
                      const base::Exec& exec, const PlateProgress& tell);

/// Mean pressure [Pa] from one sinkage to another [m].
double meanPressure(const jobs::Table& run, double area, double from, double to);
/// What theory gives as mean over the same [Pa].
double meanBearing(PlateShape shape, double angle, double unitWeight, double breadth, double from, double to);

} // namespace grouser::virtual_tests

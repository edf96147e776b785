// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/studies/bearing.hpp"
#include "runs/studies/pieces.hpp"
#include "runs/studies/soil_bed.hpp"

/// A rough rigid plate pushed down into a bed at constant speed.
namespace grouser::studies {

/// What a bed stands on.
enum class BedFloor {
  fixed, ///< grains that never move
  rough, ///< a plane with a friction of 2
  plane  ///< a plane with the grains' own friction, on which they roll
};

struct PlateTest {
  PlateShape shape = PlateShape::strip; ///< a strip reaches through both boundaries along y
  BedFloor floor = BedFloor::fixed;
  bool lattice = false;         ///< instead of a poured bed: equal spheres laid in a lattice
  double breadth = 12;          ///< [d] of a strip along x; diameter of a circular plate
  double bin = 8, depth = 2;    ///< [breadths] between the boundaries along x, and of the bed
  double thickness = 12;        ///< [d] of a strip's bed along y; beside a circular plate it is the bin's
  double sinkage = 0.3;         ///< [breadths] below the bed's surface, to which the plate is pushed
  double inertialNumber = 9e-4; ///< [-] speed over breadth times d sqrt(density / pressure expected)
  int rows = 300;               ///< of a table

  BedSize bed(const Soil& soil) const;
  double area(const Soil& soil) const;  ///< [m2]
  double speed(const Soil& soil) const; ///< [m/s]
};

/// Columns of a run's table; the last two are the same in all rows.
inline const std::vector<std::string> kPlateColumns = {"sinkage [m]", "force [N]", "porosity [-]", "grains"};

/// Prepares a bed and pushes the plate into it. `folder` is for files on the way; `keep`: where the bed is written to;
/// empty: nowhere.
Table pushPlate(const Soil& soil, const PlateTest& test, std::int64_t seed, const std::filesystem::path& folder,
                const std::filesystem::path& keep, const base::Exec& exec);

/// Mean pressure [Pa] from one sinkage to another [m].
double meanPressure(const Table& run, double area, double from, double to);
/// What theory gives as mean over the same [Pa].
double meanBearing(PlateShape shape, double angle, double unitWeight, double breadth, double from, double to);

} // namespace grouser::studies

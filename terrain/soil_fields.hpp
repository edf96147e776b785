// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_moment.hpp"
#include "terrain/grain_setup.hpp"

#include <array>
#include <cstddef>
#include <vector>

/// Fields of the soil on a regular grid: averages over the grains of each cell.
namespace grouser::terrain {

struct GrainSystem;

/// A box of equal cells.
struct FieldGrid {
  base::Vec3d low;                ///< corner of the box [m]
  base::Vec3d cell;               ///< edges of a cell [m], none shorter than the diameter of the largest grain
  std::array<int, 3> cells{};     ///< along x, y, z
  std::array<bool, 2> periodic{}; ///< along x and y: the box spans the period there

  std::size_t count() const { return static_cast<std::size_t>(cells[0]) * cells[1] * cells[2]; }
  double cellVolume() const { return cell.x * cell.y * cell.z; } ///< [m3]
};
/// Whole cells of `edge` [m] or somewhat more that fill the box, one at least along each axis.
FieldGrid fieldGrid(const base::Vec3d& low, const base::Vec3d& high, double edge, const PeriodicBoundaries& periodic);

/// Symmetric: xx, xy, xz, yy, yz, zz.
using Tensor6 = std::array<double, 6>;

/// One number, vector or tensor per cell: index x + nx (y + ny z).
///
/// A grain counts in each cell with the share of its volume that lies there. Planes between cells cut it one axis at a
/// time, so that the shares sum to 1; they are exact where one plane cuts the grain, and close where several do. So
/// the sum of a field over cells is the sum over the grains. Grains outside the box are left out. Fixed grains fill
/// volume, and are a boundary otherwise.
struct SoilFields {
  FieldGrid grid;
  std::vector<double> porosity; ///< volume without grains over volume [-]
  /// Contacts of a grain with grains and all else, mean; of those with two contacts or more (Thornton 2000,
  /// Geotechnique 50:43) [-]. NaN where there is no such grain.
  std::vector<double> coordination, mechanicalCoordination;
  std::vector<base::Vec3d> velocity; ///< mean, weighted with mass [m/s]; NaN where no grain moves freely
  /// Symmetric gradient of the velocity [1/s]: of the linear least-squares fit to the grains of the cell, weighted with
  /// mass. NaN if they are too few, or lie in one plane.
  std::vector<Tensor6> strainRate;
  /// Love-Weber: forces times lever arms of all contacts of the grains, over the volume of the cell [Pa]. Positive in
  /// tension. Forces are those of the coming step, by its laws and in its precision.
  std::vector<Tensor6> stress;
};

/// Fields of the grains as they are now; `onParts`: of their contacts with parts, by their present slots. Changes
/// nothing. The same bits on every device and any number of ranks, which all call it. The neighbour list must be
/// valid. Throws SimulationError where a sum leaves the range of its integer.
SoilFields measureFields(GrainSystem& system, const FieldGrid& grid, const contact::PartMomentsView& onParts = {});

} // namespace grouser::terrain

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

/// Box divided into equal cells.
struct FieldGrid {
  base::Vec3d low;                ///< corner of the box [m]
  base::Vec3d cell;               ///< edges of a cell [m], at least the diameter of the largest grain
  std::array<int, 3> cells{};     ///< along x, y, z
  std::array<bool, 2> periodic{}; ///< along x and y: the box spans the period

  std::size_t count() const { return static_cast<std::size_t>(cells[0]) * cells[1] * cells[2]; }
  double cellVolume() const { return cell.x * cell.y * cell.z; } ///< [m3]
};
/// Returns a grid of whole cells with edges of at least `edge` [m] that fills the box, at least one along each axis.
FieldGrid fieldGrid(const base::Vec3d& low, const base::Vec3d& high, double edge, const PeriodicBoundaries& periodic);

/// Symmetric tensor: xx, xy, xz, yy, yz, zz.
using Tensor6 = std::array<double, 6>;

/// Soil fields: one number, vector or tensor per cell, at index x + nx (y + ny z).
///
/// A grain contributes to each cell in proportion to its volume there. Planes between cells divide it one axis at a
/// time, so that the fractions sum to 1; they are exact if one plane cuts the grain, and approximate if several do. The
/// sum of a field over cells therefore equals the sum over the grains. Grains outside the box are ignored. Fixed grains
/// fill volume, but otherwise act as a boundary.
struct SoilFields {
  FieldGrid grid;
  std::vector<double> porosity; ///< void volume / total volume [-]
  /// Mean number of contacts per grain, with grains, parts and boundaries; the same mean over grains with at least two
  /// contacts (Thornton 2000, Geotechnique 50:43) [-]. NaN without such grains.
  std::vector<double> coordination, mechanicalCoordination;
  std::vector<base::Vec3d> velocity; ///< mass-weighted mean [m/s]; NaN without free grains
  /// Symmetric velocity gradient [1/s] of the linear mass-weighted least-squares fit to the grains of the cell. NaN if
  /// they are too few or coplanar.
  std::vector<Tensor6> strainRate;
  /// Love-Weber stress: sum of force times lever arm over all contacts of the grains, divided by the cell volume [Pa].
  /// Positive in tension. Forces are those of the next step, with the same laws and precision.
  std::vector<Tensor6> stress;
};

/// Measures the fields of the current grains; `onParts`: moments of their contacts with parts, by current slots. No
/// side effects. Bitwise identical on every device and any number of ranks; collective. Requires a valid neighbour
/// list. Throws SimulationError if a sum exceeds its integer range.
SoilFields measureFields(GrainSystem& system, const FieldGrid& grid, const contact::PartMomentsView& onParts = {});

} // namespace grouser::terrain

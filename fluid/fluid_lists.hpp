// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/cell_grid.hpp"
#include "fluid/fluid_view.hpp"

#include <cstddef>
#include <cstdint>

namespace grouser::fluid {

/// Neighbour lists of particles and markers within the kernel support plus a skin. Sums depend neither on the list
/// order nor on the rebuild times.
class FluidLists {
public:
  /// `reach`: support plus skin [units].
  FluidLists(const base::Exec& exec, std::int64_t reach, const base::Period& period);

  /// Sorts the particles, which precede the markers in `position`, in space: slot i receives slot order()[i].
  void sort(const base::Position* position, std::size_t particles, std::size_t markers);
  const std::uint32_t* order() const { return order_.data(); }
  /// Lists the neighbours of particles permuted by order(), except ghosts (marks; null without ghosts).
  void build(const base::Position* position, const std::uint32_t* ghost);
  std::int64_t reach() const { return reach_; } ///< [units]

  FluidRows rows() const;
  /// Markers with at least one fluid neighbour.
  const base::Array<std::uint32_t>& wetMarkers() const { return wet_; }

private:
  base::Exec exec_;
  std::int64_t reach_;
  base::Period period_;
  contact::CellGrid grid_;
  std::size_t particles_{0}, markers_{0};
  std::int64_t stride_{1};
  base::Array<std::uint32_t> order_, cellStart_, markerSlot_, markerCellStart_;
  base::Array<std::uint32_t> count_, fluidCount_, start_, slot_, wet_;
};

} // namespace grouser::fluid

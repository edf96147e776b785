// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/cell_grid.hpp"
#include "fluid/fluid_view.hpp"

#include <cstddef>
#include <cstdint>

namespace grouser::fluid {

/// Neighbours of particles and markers within the kernel's support and a skin. Sums do not depend on their order, nor
/// on when the lists are rebuilt.
class FluidLists {
public:
  /// `reach`: support and skin [units].
  FluidLists(const base::Exec& exec, std::int64_t reach, const base::Period& period);

  /// Sorts the particles in space, which precede the markers in `position`: slot i receives slot order()[i].
  void sort(const base::Position* position, std::size_t particles, std::size_t markers);
  const std::uint32_t* order() const { return order_.data(); }
  /// Lists the neighbours of particles that were permuted by order(), but those of ghosts (marks; null without).
  void build(const base::Position* position, const std::uint32_t* ghost);
  std::int64_t reach() const { return reach_; } ///< [units]

  FluidRows rows() const;
  /// Markers with a fluid neighbour.
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

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/cell_grid.hpp"

#include <cstddef>
#include <cstdint>

/// Sorting of points by grid cells, and layout of the neighbour rows.
namespace grouser::contact {

/// A grid over all points, with cells of at least `edge` [units]; wider ones where a few points far away would need too
/// many cells.
CellGrid fittedGrid(const base::Exec& exec, const base::Position* position, std::size_t count, std::int64_t edge,
                    const base::Period& period);

/// order[k]: slot of the k-th point in the order of the cells. cellStart[c]: index of the first point in cell c or
/// later; one entry more than cells.
void sortByCell(const base::Exec& exec, const CellGrid& grid, const base::Position* position, std::size_t count,
                base::Array<std::uint32_t>& order, base::Array<std::uint32_t>& cellStart);

struct RowLayout {
  std::int64_t stride;  ///< as in NeighbourRows
  std::uint32_t places; ///< places in all rows
};

/// Starts of rows of count[i] places: behind one another on a CPU, by slices of 32 rows side by side on a GPU. Throws
/// SimulationError if there are too many places for 32 bits; `spare` places behind the last are readable.
RowLayout layRows(const base::Exec& exec, const base::Array<std::uint32_t>& count, base::Array<std::uint32_t>& start,
                  std::size_t spare = 0);

} // namespace grouser::contact

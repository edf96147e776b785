// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/cell_grid.hpp"

#include <cstddef>
#include <cstdint>

/// Sorting of points by grid cells, and layout of the neighbour rows.
namespace grouser::contact {

/// Returns a grid over all points with cells of at least `edge` [units], wider if a few distant points would require
/// too many cells.
CellGrid fittedGrid(const base::Exec& exec, const base::Position* position, std::size_t count, std::int64_t edge,
                    const base::Period& period);

/// Sorts points by cell. order[k]: slot of the k-th point in cell order. cellStart[c]: index of the first point in cell
/// c or a later cell; it has one more entry than there are cells.
void sortByCell(const base::Exec& exec, const CellGrid& grid, const base::Position* position, std::size_t count,
                base::Array<std::uint32_t>& order, base::Array<std::uint32_t>& cellStart);

struct RowLayout {
  std::int64_t stride;  ///< as in NeighbourRows
  std::uint32_t places; ///< places in all rows
};

/// Sets the start of each row of count[i] places: consecutive on a CPU, interleaved in slices of 32 rows on a GPU.
/// Throws SimulationError if the number of places exceeds 32 bits; `spare` extra places at the end are readable.
RowLayout layRows(const base::Exec& exec, const base::Array<std::uint32_t>& count, base::Array<std::uint32_t>& start,
                  std::size_t spare = 0);

} // namespace grouser::contact

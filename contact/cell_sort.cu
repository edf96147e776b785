// SPDX-License-Identifier: BSD-3-Clause
#include "contact/cell_sort.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "contact/cell_search.cuh"
#include "contact/neighbour_rows.cuh"

#include <string>

namespace grouser::contact {

namespace {

void checkPlaces(std::uint64_t places, std::size_t rows) {
  if (places >= std::uint64_t{1} << 32)
    throw base::SimulationError("the neighbour lists of " + std::to_string(rows) + " elements have " +
                                std::to_string(places) + " entries, more than 2^32; use more ranks, or a smaller skin");
}

} // namespace

CellGrid fittedGrid(const base::Exec& exec, const base::Position* position, std::size_t count, std::int64_t edge,
                    const base::Period& period) {
  const auto n = static_cast<std::int64_t>(count);
  const double most = 16.0 * static_cast<double>(count) + 1e6;
  base::Array<std::uint32_t> bounds(exec, 6);
  CellGrid grid;
  grid.period = period;
  for (;; edge *= 2) {
    grid.setEdge(edge);
    bounds.zero();
    base::forEach(exec, "find grid bounds", sharesOf(n), FindBounds<CellGrid>{grid, position, n, bounds.data()});
    const std::vector<std::uint32_t> b = bounds.toHost();
    double all = 1;
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (!period.along(a)) grid.low[a] = ~b[k], grid.cells[a] = b[k + 3] - grid.low[a] + 1;
      all *= grid.cells[a];
    }
    if (all <= most) return grid;
  }
}

void sortByCell(const base::Exec& exec, const CellGrid& grid, const base::Position* position, std::size_t count,
                base::Array<std::uint32_t>& order, base::Array<std::uint32_t>& cellStart) {
  const auto n = static_cast<std::int64_t>(count);
  const std::int64_t cells = static_cast<std::int64_t>(grid.cells.x) * grid.cells.y * grid.cells.z;
  order.resize(count);
  cellStart.resize(static_cast<std::size_t>(cells) + 1);
  if (count == 0) return cellStart.zero(); // MarkStarts would write all entries in one thread
  base::Array<std::uint64_t> key(exec, count);
  base::forEach(exec, "assign cell keys", n, AssignKeys<CellGrid>{grid, position, key.data()});
  base::iota(exec, order.data(), count);
  base::sortByKey(exec, key.data(), order.data(), count);
  base::forEach(exec, "mark cell starts", n + 1, MarkStarts{key.data(), n, cells, cellStart.data()});
}

RowLayout layRows(const base::Exec& exec, const base::Array<std::uint32_t>& count, base::Array<std::uint32_t>& start,
                  std::size_t spare) {
  const std::size_t n = count.size();
  start.resize(n);
  if (exec.onCpu()) {
    checkPlaces(base::sum(exec, count.data(), n) + spare, n);
    return {1, base::exclusiveScan(exec, count.data(), start.data(), n)};
  }
  const std::size_t slices = (n + kSlice - 1) / kSlice;
  base::Array<std::uint32_t> longest(exec, slices);
  base::forEach(exec, "measure slices", static_cast<std::int64_t>(slices),
                LongestOfSlice{count.data(), static_cast<std::int64_t>(n), longest.data()});
  checkPlaces(base::sum(exec, longest.data(), slices) * kSlice + spare, n);
  const std::uint32_t places = base::exclusiveScan(exec, longest.data(), longest.data(), slices);
  base::forEach(exec, "lay rows", static_cast<std::int64_t>(n), StartInSlice{longest.data(), start.data()});
  return {kSlice, places * kSlice};
}

} // namespace grouser::contact

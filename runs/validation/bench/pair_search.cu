// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/bench/pair_search.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/gather.cuh"
#include "runs/validation/bench/pair_kernels.cuh"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace grouser::bench {

using base::Position;
using contact::AssignKeys;
using contact::Cell;
using contact::FindBounds;
using contact::MarkStarts;
using contact::sharesOf;
using namespace detail; // the kernels

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kSample = 1 << 22; // size of the sample that determines the slabs
constexpr std::size_t kAtATimeOnGpu = 250000000;
constexpr std::int64_t kMaxSpheres = 2147483646; // maximum count of forEach minus 1 for the end marker

} // namespace

struct PairSearch::Work {
  Work(const base::Exec& e, std::int64_t d)
      : exec(e), diameter(d), marks(e), list(e), start(e), counts(e), small(e), key(e), position(e), total(e, 1) {}

  struct Grid {
    Cell low, cells;
    std::int64_t edge;
  };
  /// Range of cell layers along x; their spheres search for neighbours.
  struct Slab {
    std::uint32_t from, to;
  };

  Grid gridOver(const Position* positions, std::int64_t count);
  /// Cuts the layers into about `wanted` slabs with about equal numbers of spheres.
  std::vector<Slab> cut(const Grid& grid, const Position* positions, std::int64_t count, std::size_t wanted);
  SlabGrid gridOf(const Slab& slab, const Grid& grid) const;
  std::int64_t choose(const Slab& slab, const Grid& grid, const Position* positions, std::int64_t count);
  std::int64_t sort(const Slab& slab, const SlabGrid& grid, const Position* positions, std::int64_t chosen);
  Neighbourhood neighbourhood(const SlabGrid& grid) const;
  std::int64_t countPairs(const Neighbourhood& near, std::int64_t owned);
  base::Array<IdPair> storePairs(const Neighbourhood& near, std::int64_t owned, std::int64_t sum);
  std::size_t bytes() const;

  base::Exec exec;
  std::int64_t diameter;
  base::Array<std::uint32_t> marks, list, start, counts, small;
  base::Array<std::uint64_t> key;
  base::Array<Position> position;
  base::Array<std::int64_t> total;
};

PairSearch::Work::Grid PairSearch::Work::gridOver(const Position* positions, std::int64_t count) {
  // A few distant spheres must not make the grid huge: enlarge the cells until the grid fits.
  const double most = 16.0 * static_cast<double>(count) + 1e6;
  small.resize(6);
  for (std::int64_t edge = diameter;; edge *= 2) {
    small.zero();
    base::forEach(exec, "find bounds of spheres", sharesOf(count),
                  FindBounds<SlabGrid>{{{Divider(edge)}, {}, {}}, positions, count, small.data()});
    const std::vector<std::uint32_t> b = small.toHost();
    const Cell low{~b[0], ~b[1], ~b[2]}, cells{b[3] - low.x + 1, b[4] - low.y + 1, b[5] - low.z + 1};
    if (static_cast<double>(cells.x) * cells.y * cells.z <= most) return {low, cells, edge};
  }
}

std::vector<PairSearch::Work::Slab> PairSearch::Work::cut(const Grid& grid, const Position* positions,
                                                          std::int64_t count, std::size_t wanted) {
  if (wanted <= 1) return {{0, grid.cells.x}};
  const std::int64_t stride = std::max<std::int64_t>(1, count / kSample);
  const std::int64_t sampled = count / stride;
  small.resize(grid.cells.x);
  small.zero();
  base::forEach(exec, "count spheres by layer", sampled,
                CountLayers{{Divider(grid.edge)}, positions, stride, grid.low.x, small.data()});
  const std::vector<std::uint32_t> layers = small.toHost();
  // Each slab consists of whole layers that contain its share of the sample.
  const double share = static_cast<double>(sampled) / static_cast<double>(wanted);
  std::vector<Slab> slabs;
  double held = 0;
  for (std::uint32_t from = 0, to = 1; to <= grid.cells.x; ++to) {
    held += layers[to - 1];
    if (to < grid.cells.x && held < share * static_cast<double>(slabs.size() + 1)) continue;
    slabs.push_back({from, to});
    from = to;
  }
  return slabs;
}

SlabGrid PairSearch::Work::gridOf(const Slab& slab, const Grid& grid) const {
  const std::uint32_t layers = std::min(slab.to + 1, grid.cells.x) - slab.from;
  return {{Divider(grid.edge)}, {grid.low.x + slab.from, grid.low.y, grid.low.z}, {layers, grid.cells.y, grid.cells.z}};
}

/// Lists the spheres of the slab and of the next layer. Returns the number of these spheres.
std::int64_t PairSearch::Work::choose(const Slab& slab, const Grid& grid, const Position* positions,
                                      std::int64_t count) {
  const auto n = static_cast<std::size_t>(count);
  if (slab.from == 0 && slab.to == grid.cells.x) {
    list.resize(n);
    base::iota(exec, list.data(), n);
    return count;
  }
  marks.resize(n);
  base::forEach(
      exec, "mark spheres of a slab", count,
      MarkLayers{{Divider(grid.edge)}, positions, grid.low.x + slab.from, grid.low.x + slab.to + 1, marks.data()});
  const std::uint32_t chosen = base::exclusiveScan(exec, marks.data(), marks.data(), n);
  list.resize(chosen);
  base::forEach(exec, "list spheres of a slab", count, ListMarked{marks.data(), count, chosen, list.data()});
  return chosen;
}

/// Sorts the chosen spheres by cell and gathers their positions. The spheres of the slab itself come first; returns
/// their number.
std::int64_t PairSearch::Work::sort(const Slab& slab, const SlabGrid& grid, const Position* positions,
                                    std::int64_t chosen) {
  const auto n = static_cast<std::size_t>(chosen);
  key.resize(n);
  base::forEach(exec, "assign cells", chosen, AssignKeys<SlabGrid>{grid, positions, key.data(), list.data()});
  base::sortByKey(exec, key.data(), list.data(), n);
  const std::int64_t column = static_cast<std::int64_t>(grid.cells.y) * grid.cells.z, cells = column * grid.cells.x;
  start.resize(static_cast<std::size_t>(cells) + 1);
  base::forEach(exec, "mark cell starts", chosen + 1, MarkStarts{key.data(), chosen, cells, start.data()});
  position.resize(n);
  base::forEach(exec, "gather positions", chosen, base::Gather<Position>{list.data(), positions, position.data()});
  return start.at(static_cast<std::size_t>(column * (slab.to - slab.from)));
}

Neighbourhood PairSearch::Work::neighbourhood(const SlabGrid& grid) const {
  const auto edge = static_cast<std::int64_t>(grid.cellOf.divide.edge);
  // Along each axis, spheres in neighbouring cells are less than two edges apart; squares of distances fit in 64 bits.
  return {grid, position.data(), start.data(), diameter * diameter, edge >= std::int64_t{1} << 29};
}

std::int64_t PairSearch::Work::countPairs(const Neighbourhood& near, std::int64_t owned) {
  counts.resize(static_cast<std::size_t>(owned));
  base::forEach(exec, "count touching pairs", owned, Count{near, counts.data()});
  total.zero();
  base::forEach(exec, "sum pairs", sharesOf(owned), SumCounts{counts.data(), owned, total.data()});
  return total.at(0);
}

base::Array<IdPair> PairSearch::Work::storePairs(const Neighbourhood& near, std::int64_t owned, std::int64_t sum) {
  if (sum > std::int64_t{0xFFFFFFFF})
    throw base::SimulationError("one slab has more than 2^32 contacts: the spheres overlap too much, or the slabs are "
                                "too large; reduce --at-a-time");
  base::exclusiveScan(exec, counts.data(), counts.data(), static_cast<std::size_t>(owned));
  base::Array<IdPair> pairs(exec, static_cast<std::size_t>(sum));
  base::forEach(exec, "store touching pairs", owned, Store{near, list.data(), counts.data(), pairs.data()});
  return pairs;
}

std::size_t PairSearch::Work::bytes() const {
  // The sort needs two copies of keys and indices.
  return marks.bytes() + 2 * list.bytes() + start.bytes() + counts.bytes() + small.bytes() + 2 * key.bytes() +
         position.bytes();
}

PairSearch::PairSearch(const base::Exec& exec, std::int64_t diameter) : work_(new Work(exec, diameter)) {
  if (diameter <= 0 || diameter >= std::int64_t{1} << 29)
    throw std::invalid_argument("the diameter of a pair search must be above 0 and below 2^29 units");
}

PairSearch::~PairSearch() = default;

FoundPairs PairSearch::find(const Position* positions, std::size_t count, const PairSearchOptions& options) {
  if (count > static_cast<std::size_t>(kMaxSpheres))
    throw std::invalid_argument("a pair search supports at most 2^31 - 2 spheres");
  FoundPairs found;
  if (count == 0) return found;
  Work& work = *work_;
  const auto n = static_cast<std::int64_t>(count);
  const auto parts = static_cast<std::size_t>(options.of);
  const std::size_t wished = options.atATime ? options.atATime : work.exec.onCpu() ? count : kAtATimeOnGpu;
  const std::size_t atATime = std::min(wished, count);
  // All parts have the same number of slabs and about the same number of spheres.
  const std::size_t rounds = std::max<std::size_t>(1, (count + atATime * parts - 1) / (atATime * parts));
  Clock::time_point last = Clock::now();
  const auto addTime = [&](double& seconds) {
    base::synchronize(work.exec);
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - last).count();
    last = now;
  };

  const Work::Grid grid = work.gridOver(positions, n);
  const std::vector<Work::Slab> slabs = work.cut(grid, positions, n, rounds * parts);
  addTime(found.gridSeconds);
  for (std::size_t s = static_cast<std::size_t>(options.share); s < slabs.size(); s += parts) {
    ++found.slabs;
    const std::int64_t chosen = work.choose(slabs[s], grid, positions, n);
    if (chosen == 0) continue;
    const SlabGrid slabGrid = work.gridOf(slabs[s], grid);
    const std::int64_t owned = work.sort(slabs[s], slabGrid, positions, chosen);
    addTime(found.sortSeconds);
    const Neighbourhood near = work.neighbourhood(slabGrid);
    const std::int64_t touching = work.countPairs(near, owned);
    found.count += touching;
    addTime(found.countSeconds);
    if (!options.store || touching == 0) continue;
    found.pairs.push_back(work.storePairs(near, owned, touching));
    addTime(found.storeSeconds);
  }
  found.workBytes = work.bytes();
  return found;
}

} // namespace grouser::bench

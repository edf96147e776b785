// SPDX-License-Identifier: BSD-3-Clause
#include "contact/pair_search.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/for_each.cuh"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace grouser::contact {

using base::Position;
using base::Vec3i;
using base::Vec3l;

namespace {

using Cell = base::Vec3<std::uint32_t>;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kItems = 512;      // of a thread that goes over many
constexpr std::int64_t kSample = 1 << 22; // spheres that the slabs are cut by
constexpr std::size_t kAtATimeOnGpu = 250000000;
constexpr std::int64_t kMostSpheres = 2147483646; // what forEach counts to, less the one that marks the end

/// Quotients of 42-bit numbers by the cells' edge, without a division.
struct Divider {
  std::uint64_t edge, inverse;
  explicit Divider(std::int64_t e) : edge(static_cast<std::uint64_t>(e)), inverse(~std::uint64_t{0} / edge) {}

  GROUSER_HD std::uint32_t operator()(std::uint64_t u) const {
#if defined(__CUDA_ARCH__)
    std::uint64_t q = __umul64hi(u, inverse);
#else
    auto q = static_cast<std::uint64_t>(static_cast<unsigned __int128>(u) * inverse >> 64);
#endif
    // The inverse is rounded down: q may be one too small.
    if (u - q * edge >= edge) ++q;
    return static_cast<std::uint32_t>(q);
  }
};

/// Cell of a sphere, counted from the lowest representable position.
struct CellOf {
  Divider divide;
  GROUSER_HD std::uint32_t along(std::int64_t u) const {
    constexpr std::int64_t kBias = std::int64_t{1} << 41;
    return divide(static_cast<std::uint64_t>(u + kBias));
  }
  GROUSER_HD std::uint32_t x(const Position& p) const { return along(base::axisOf(p.x, p.high, 0)); }
  GROUSER_HD Cell operator()(const Position& p) const {
    const Vec3l u = base::toUnits(p);
    return {along(u.x), along(u.y), along(u.z)};
  }
};

/// Lowest and highest cell in use. bounds[0..2] hold the complement of the minimum, so that all six grow.
struct FindBounds {
  CellOf cellOf;
  const Position* position;
  std::int64_t count, threads;
  std::uint32_t* bounds;

  GROUSER_HD static void raiseTo(std::uint32_t* target, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
    if (value > *target) atomicMax(target, value); // most find it raised already; a stale look costs one atomic more
#else
    std::uint32_t old = __atomic_load_n(target, __ATOMIC_RELAXED);
    while (value > old && !__atomic_compare_exchange_n(target, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
#endif
  }
  GROUSER_HD void operator()(int thread) const {
    Cell low{~0u, ~0u, ~0u}, high{0, 0, 0};
    for (std::int64_t i = thread; i < count; i += threads) {
      const Cell c = cellOf(position[i]);
      low = base::min(low, c), high = base::max(high, c);
    }
    for (int a = 0; a < 3; ++a) {
      raiseTo(bounds + a, ~low[a]);
      raiseTo(bounds + 3 + a, high[a]);
    }
  }
};

/// How many spheres of a sample lie in each layer of cells along x.
struct CountLayers {
  CellOf cellOf;
  const Position* position;
  std::int64_t stride;
  std::uint32_t low;
  std::uint32_t* layers;
  GROUSER_HD void operator()(int i) const { base::atomicAdd32(layers + (cellOf.x(position[i * stride]) - low), 1u); }
};

/// mark[i] = 1 for the spheres of layers [from, to).
struct MarkLayers {
  CellOf cellOf;
  const Position* position;
  std::uint32_t from, to;
  std::uint32_t* mark;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t x = cellOf.x(position[i]);
    mark[i] = x >= from && x < to;
  }
};

/// Lists the marked ones by the sums of the marks before them.
struct ListMarked {
  const std::uint32_t* before;
  std::int64_t count;
  std::uint32_t total;
  std::uint32_t* list;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t mine = before[i], next = i + 1 < count ? before[i + 1] : total;
    if (next != mine) list[mine] = static_cast<std::uint32_t>(i);
  }
};

/// Dense grid over a slab; z runs fastest, so the three cells of a column are neighbours in memory, and x slowest, so
/// that the layer of the next slab comes last.
struct SlabGrid {
  CellOf cellOf;
  Cell low, cells;
  GROUSER_HD std::uint64_t key(const Cell& c) const {
    return (static_cast<std::uint64_t>(c.x) * cells.y + c.y) * cells.z + c.z;
  }
  GROUSER_HD Cell local(const Position& p) const {
    const Cell c = cellOf(p);
    return {c.x - low.x, c.y - low.y, c.z - low.z};
  }
};

struct AssignKeys {
  SlabGrid grid;
  const Position* position;
  const std::uint32_t* list;
  std::uint64_t* key;
  GROUSER_HD void operator()(int i) const { key[i] = grid.key(grid.local(position[list[i]])); }
};

/// start[c] = first place whose key is >= c, for c in [0, cells].
struct MarkStarts {
  const std::uint64_t* key;
  std::int64_t count, cells;
  std::uint32_t* start;
  GROUSER_HD void operator()(int i) const {
    const std::int64_t before = i == 0 ? -1 : static_cast<std::int64_t>(key[i - 1]);
    const std::int64_t here = i == count ? cells : static_cast<std::int64_t>(key[i]);
    for (std::int64_t c = before + 1; c <= here; ++c) start[c] = static_cast<std::uint32_t>(i);
  }
};

struct Gather {
  const Position* from;
  const std::uint32_t* list;
  Position* to;
  GROUSER_HD void operator()(int i) const { to[i] = from[list[i]]; }
};

/// What the search of one slab reads.
struct Neighbourhood {
  SlabGrid grid;
  const Position* position; ///< sorted by cell
  const std::uint32_t* start;
  std::int64_t reach2;
  bool checkFar; ///< cells are so wide that 32-bit differences may wrap

  GROUSER_HD bool touch(const Position& a, const Position& b) const {
    if (checkFar) {
      constexpr std::int64_t kSafe = std::int64_t{1} << 30;
      const Vec3l apart = base::toUnits(b) - base::toUnits(a);
      if (apart.x >= kSafe || apart.x <= -kSafe || apart.y >= kSafe || apart.y <= -kSafe || apart.z >= kSafe ||
          apart.z <= -kSafe)
        return false;
    }
    return base::squaredNorm(base::difference(a, b)) < reach2;
  }

  /// Calls visit(j, whether j touches i) for each sphere j that comes after i: in i's cell, or in one of the 13 that
  /// follow it.
  template <class Visit> GROUSER_HD void forLater(std::uint32_t i, Visit& visit) const {
    const Position p = position[i];
    const Cell c = grid.local(p);
    const std::uint32_t z0 = c.z == 0 ? 0 : c.z - 1, z1 = c.z + 1 < grid.cells.z ? c.z + 1 : c.z;
    across(p, i + 1, start[grid.key({c.x, c.y, z1}) + 1], visit);
    // Columns (0, 1), (1, -1), (1, 0), (1, 1) from here.
    for (std::uint32_t column = 0; column < 4; ++column) {
      const std::uint32_t x = column == 0 ? c.x : c.x + 1, y = column == 0 ? c.y + 1 : c.y + column - 2;
      if (x >= grid.cells.x || y >= grid.cells.y) continue; // -1 wraps to a large number
      const std::uint64_t row = grid.key({x, y, 0});
      across(p, start[row + z0], start[row + z1 + 1], visit);
    }
  }

private:
  template <class Visit>
  GROUSER_HD void across(const Position& p, std::uint32_t first, std::uint32_t last, Visit& visit) const {
    for (std::uint32_t j = first; j < last; ++j) visit(j, touch(p, position[j]));
  }
};

struct Count {
  Neighbourhood near;
  std::uint32_t* counts;

  struct Add {
    std::uint32_t n;
    GROUSER_HD void operator()(std::uint32_t, bool touches) { n += touches; }
  };
  GROUSER_HD void operator()(int i) const {
    Add add{0};
    near.forLater(static_cast<std::uint32_t>(i), add);
    counts[i] = add.n;
  }
};

struct SumCounts {
  const std::uint32_t* counts;
  std::int64_t count, threads;
  std::int64_t* total;
  GROUSER_HD void operator()(int thread) const {
    std::int64_t sum = 0;
    for (std::int64_t i = thread; i < count; i += threads) sum += counts[i];
    base::atomicAdd64(total, sum);
  }
};

struct Store {
  Neighbourhood near;
  const std::uint32_t *list, *offset;
  IdPair* pairs;

  struct Put {
    const std::uint32_t* list;
    std::uint32_t id;
    IdPair* next;
    GROUSER_HD void operator()(std::uint32_t j, bool touches) {
      if (!touches) return;
      const std::uint32_t other = list[j];
      *next++ = id < other ? IdPair{id, other} : IdPair{other, id};
    }
  };
  GROUSER_HD void operator()(int i) const {
    Put put{list, list[i], pairs + offset[i]};
    near.forLater(static_cast<std::uint32_t>(i), put);
  }
};

/// Threads of kItems items each.
std::int64_t threadsFor(std::int64_t count) { return (count + kItems - 1) / kItems; }

} // namespace

struct PairSearch::Work {
  Work(const base::Exec& e, std::int64_t d)
      : exec(e), diameter(d), marks(e), list(e), start(e), counts(e), small(e), key(e), position(e), total(e, 1) {}

  struct Grid {
    Cell low, cells;
    std::int64_t edge;
  };
  /// Layers of cells along x whose spheres look for others, from the grid's lowest on.
  struct Slab {
    std::uint32_t from, to;
  };

  Grid gridOver(const Position* positions, std::int64_t count);
  std::vector<Slab> cut(const Grid& grid, const Position* positions, std::int64_t count, std::size_t atATime);
  SlabGrid gridOf(const Slab& slab, const Grid& grid) const;
  std::int64_t choose(const Slab& slab, const Grid& grid, const Position* positions, std::int64_t count);
  std::int64_t sort(const Slab& slab, const SlabGrid& grid, const Position* positions, std::int64_t chosen);
  Neighbourhood neighbourhood(const SlabGrid& grid) const;
  std::int64_t countPairs(const Neighbourhood& near, std::int64_t owned);
  base::Array<IdPair> storePairs(const Neighbourhood& near, std::int64_t owned, std::int64_t total);
  std::size_t bytes() const;

  base::Exec exec;
  std::int64_t diameter;
  base::Array<std::uint32_t> marks, list, start, counts, small;
  base::Array<std::uint64_t> key;
  base::Array<Position> position;
  base::Array<std::int64_t> total;
};

PairSearch::Work::Grid PairSearch::Work::gridOver(const Position* positions, std::int64_t count) {
  // A few spheres far away must not make the grid huge: widen its cells until it fits.
  const double most = 16.0 * static_cast<double>(count) + 1e6;
  const std::int64_t threads = threadsFor(count);
  small.resize(6);
  for (std::int64_t edge = diameter;; edge *= 2) {
    small.zero();
    base::forEach(exec, "find bounds of spheres", threads,
                  FindBounds{{Divider(edge)}, positions, count, threads, small.data()});
    const std::vector<std::uint32_t> b = small.toHost();
    const Cell low{~b[0], ~b[1], ~b[2]}, cells{b[3] - low.x + 1, b[4] - low.y + 1, b[5] - low.z + 1};
    if (static_cast<double>(cells.x) * cells.y * cells.z <= most) return {low, cells, edge};
  }
}

std::vector<PairSearch::Work::Slab> PairSearch::Work::cut(const Grid& grid, const Position* positions,
                                                          std::int64_t count, std::size_t atATime) {
  if (static_cast<std::size_t>(count) <= atATime) return {{0, grid.cells.x}};
  const std::int64_t stride = std::max<std::int64_t>(1, count / kSample);
  small.resize(grid.cells.x);
  small.zero();
  base::forEach(exec, "count spheres by layer", count / stride,
                CountLayers{{Divider(grid.edge)}, positions, stride, grid.low.x, small.data()});
  const std::vector<std::uint32_t> layers = small.toHost();
  // As many layers as fit, with the one after them, and at least one.
  const double most = static_cast<double>(atATime) / static_cast<double>(stride);
  const auto held = [&](std::uint32_t layer) { return layer < grid.cells.x ? double(layers[layer]) : 0.0; };
  std::vector<Slab> slabs;
  for (std::uint32_t from = 0, to; from < grid.cells.x; from = to) {
    to = from + 1;
    for (double sum = held(from); to < grid.cells.x && sum + held(to) + held(to + 1) <= most; ++to) sum += held(to);
    slabs.push_back({from, to});
  }
  return slabs;
}

SlabGrid PairSearch::Work::gridOf(const Slab& slab, const Grid& grid) const {
  const std::uint32_t layers = std::min(slab.to + 1, grid.cells.x) - slab.from;
  return {{Divider(grid.edge)}, {grid.low.x + slab.from, grid.low.y, grid.low.z}, {layers, grid.cells.y, grid.cells.z}};
}

/// Lists the spheres of the slab and of the layer after it. Returns how many they are.
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

/// Sorts the chosen spheres by cell and gathers their positions. Returns how many of them are the slab's own: the first
/// ones.
std::int64_t PairSearch::Work::sort(const Slab& slab, const SlabGrid& grid, const Position* positions,
                                    std::int64_t chosen) {
  const auto n = static_cast<std::size_t>(chosen);
  key.resize(n);
  base::forEach(exec, "assign cells", chosen, AssignKeys{grid, positions, list.data(), key.data()});
  base::sortByKey(exec, key.data(), list.data(), n);
  const std::int64_t column = static_cast<std::int64_t>(grid.cells.y) * grid.cells.z, cells = column * grid.cells.x;
  start.resize(static_cast<std::size_t>(cells) + 1);
  base::forEach(exec, "mark cell starts", chosen + 1, MarkStarts{key.data(), chosen, cells, start.data()});
  position.resize(n);
  base::forEach(exec, "gather positions", chosen, Gather{positions, list.data(), position.data()});
  return start.at(static_cast<std::size_t>(column * (slab.to - slab.from)));
}

Neighbourhood PairSearch::Work::neighbourhood(const SlabGrid& grid) const {
  const auto edge = static_cast<std::int64_t>(grid.cellOf.divide.edge);
  // Spheres in neighbouring cells are less than two edges apart, and squares of up to 2^30 add up within 64 bits.
  return {grid, position.data(), start.data(), diameter * diameter, edge >= std::int64_t{1} << 29};
}

std::int64_t PairSearch::Work::countPairs(const Neighbourhood& near, std::int64_t owned) {
  counts.resize(static_cast<std::size_t>(owned));
  base::forEach(exec, "count touching pairs", owned, Count{near, counts.data()});
  const std::int64_t threads = threadsFor(owned);
  total.zero();
  base::forEach(exec, "sum pairs", threads, SumCounts{counts.data(), owned, threads, total.data()});
  return total.at(0);
}

base::Array<IdPair> PairSearch::Work::storePairs(const Neighbourhood& near, std::int64_t owned, std::int64_t sum) {
  if (sum > std::int64_t{0xFFFFFFFF})
    throw base::SimulationError("more than 2^32 pairs of touching spheres in one slab: the spheres have collapsed into "
                                "each other, or fewer must be searched at a time");
  base::exclusiveScan(exec, counts.data(), counts.data(), static_cast<std::size_t>(owned));
  base::Array<IdPair> pairs(exec, static_cast<std::size_t>(sum));
  base::forEach(exec, "store touching pairs", owned, Store{near, list.data(), counts.data(), pairs.data()});
  return pairs;
}

std::size_t PairSearch::Work::bytes() const {
  // Sorting needs keys and places twice.
  return marks.bytes() + 2 * list.bytes() + start.bytes() + counts.bytes() + small.bytes() + 2 * key.bytes() +
         position.bytes();
}

PairSearch::PairSearch(const base::Exec& exec, std::int64_t diameter) : work_(new Work(exec, diameter)) {
  if (diameter <= 0 || diameter >= std::int64_t{1} << 29)
    throw std::invalid_argument("the diameter of a pair search must be above 0 and below 2^29 units");
}

PairSearch::~PairSearch() = default;

FoundPairs PairSearch::find(const Position* positions, std::size_t count, const PairSearchOptions& options) {
  if (count > static_cast<std::size_t>(kMostSpheres))
    throw std::invalid_argument("a pair search takes 2^31 - 2 spheres at most");
  FoundPairs found;
  if (count == 0) return found;
  Work& work = *work_;
  const auto n = static_cast<std::int64_t>(count);
  const auto parts = static_cast<std::size_t>(options.of);
  std::size_t atATime = options.atATime ? options.atATime : work.exec.onCpu() ? count : kAtATimeOnGpu;
  atATime = std::min(atATime, (count + parts - 1) / parts);
  Clock::time_point last = Clock::now();
  const auto addTime = [&](double& seconds) {
    base::synchronize(work.exec);
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - last).count();
    last = now;
  };

  const Work::Grid grid = work.gridOver(positions, n);
  const std::vector<Work::Slab> slabs = work.cut(grid, positions, n, atATime);
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

} // namespace grouser::contact

// SPDX-License-Identifier: BSD-3-Clause
#include "contact/neighbour_list.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/for_each.cuh"

#include <algorithm>
#include <cstring>

namespace grouser::contact {

using base::Position;
using base::Vec3i;
using base::Vec3l;

namespace {

constexpr std::uint32_t kMostEqual = 64;    // neighbours of equal spheres: one word of touching bits
constexpr std::uint32_t kMostOthers = 1024; // of spheres of several sizes
constexpr int kChunk = 512;

using Cell = CellGrid::Cell;

/// Lowest and highest cell in use. bounds[0..2] hold the complement of the minimum, so that all six grow.
struct FindBounds {
  CellGrid grid;
  const Position* position;
  std::int64_t count;
  std::uint32_t* bounds;

  GROUSER_HD static void raiseTo(std::uint32_t* target, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
    atomicMax(target, value);
#else
    std::uint32_t old = __atomic_load_n(target, __ATOMIC_RELAXED);
    while (value > old && !__atomic_compare_exchange_n(target, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
#endif
  }
  GROUSER_HD void operator()(int chunk) const {
    const std::int64_t first = static_cast<std::int64_t>(chunk) * kChunk;
    const std::int64_t last = first + kChunk < count ? first + kChunk : count;
    Cell low{~0u, ~0u, ~0u}, high{0, 0, 0};
    for (std::int64_t i = first; i < last; ++i) {
      const Cell c = grid.cellOf(position[i]);
      low = base::min(low, c), high = base::max(high, c);
    }
    for (int a = 0; a < 3; ++a) {
      raiseTo(bounds + a, ~low[a]);
      raiseTo(bounds + 3 + a, high[a]);
    }
  }
};

struct AssignKeys {
  CellGrid grid;
  const Position* position;
  std::uint64_t* key;
  GROUSER_HD void operator()(int i) const { key[i] = grid.key(grid.local(position[i])); }
};

/// start[c] = first slot whose key is >= c, for c in [0, cells].
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

/// Collects the neighbours of one grain and orders them by global id.
struct Collect {
  CellGrid grid;
  const Position* position;
  const std::uint32_t* id;
  const std::uint32_t* start;
  std::int64_t reach2;
  std::uint32_t capacity;
  std::uint32_t *count, *slot;
  std::int64_t grainStride, slotStride;
  const std::uint32_t* ghost; ///< null where all grains have rows
  RadiiInW radii;
  std::int64_t skin;

  GROUSER_HD std::int64_t at(int i, std::uint32_t k) const { return i * grainStride + k * slotStride; }

  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) {
      count[i] = 0;
      return;
    }
    const Position p = position[i];
    const Cell c = grid.local(p);
    const std::int64_t own = radii.sphere ? radii.units(i) + skin : 0;
    const std::uint32_t z0 = c.z == 0 ? 0 : c.z - 1, z1 = c.z + 1 < grid.cells.z ? c.z + 1 : c.z;
    std::uint32_t found = 0;
    for (int column = 0; column < 9; ++column) {
      std::uint32_t x = c.x + static_cast<std::uint32_t>(column / 3) - 1,
                    y = c.y + static_cast<std::uint32_t>(column % 3) - 1;
      if (!besides(0, x) || !besides(1, y)) continue;
      const std::uint32_t last = start[grid.key({x, y, z1}) + 1];
      for (std::uint32_t j = start[grid.key({x, y, z0})]; j < last; ++j) {
        if (static_cast<int>(j) == i) continue;
        const Vec3l apart = grid.period.apart(p, position[j]);
        if (!near(apart)) continue;
        const std::int64_t reach = radii.sphere ? own + radii.units(static_cast<int>(j)) : 0;
        if (base::squaredNorm(apart.as<std::int32_t>()) >= (radii.sphere ? reach * reach : reach2)) continue;
        if (found < capacity) insert(i, found, j);
        ++found;
      }
    }
    count[i] = found;
    for (; found < capacity; ++found) slot[at(i, found)] = static_cast<std::uint32_t>(i);
  }

  /// Whether there is such a cell beside one in use along x or y; across joined sides it is at the other end.
  GROUSER_HD bool besides(int axis, std::uint32_t& c) const {
    const std::uint32_t cells = grid.cells[axis];
    if (grid.period.along(axis)) c = c == cells ? 0 : c > cells ? cells - 1 : c;
    return c < cells;
  }

  /// Whether 32-bit differences hold: cells may have been widened for grains far away.
  GROUSER_HD static bool near(const Vec3l& apart) {
    constexpr std::int64_t kSafe = std::int64_t{1} << 30;
    return apart.x < kSafe && apart.x > -kSafe && apart.y < kSafe && apart.y > -kSafe && apart.z < kSafe &&
           apart.z > -kSafe;
  }

  GROUSER_HD void insert(int i, std::uint32_t filled, std::uint32_t j) const {
    const std::uint32_t wanted = id[j];
    std::uint32_t k = filled;
    while (k > 0 && id[slot[at(i, k - 1)]] > wanted) {
      slot[at(i, k)] = slot[at(i, k - 1)];
      --k;
    }
    slot[at(i, k)] = j;
  }
};

/// Takes the history of pairs that stood in the old list too.
struct CarryHistory {
  const std::uint32_t* order; ///< old row of each new slot, or RowOrigins
  const std::uint32_t* id;
  const std::uint32_t *count, *slot;
  std::int64_t grainStride, slotStride, maskWords;
  int width; ///< numbers of history of a contact
  float* history;
  std::uint64_t* touching;
  const std::uint32_t *oldCount, *oldSlot, *oldId;
  const float* oldHistory;
  const std::uint64_t* oldTouching;
  std::int64_t oldGrainStride, oldSlotStride, oldMaskWords;
  std::uint32_t former; ///< rows in the old list; later ones are in `arrived`
  TravellingRows arrived;

  GROUSER_HD void operator()(int i) const {
    for (std::int64_t w = 0; w < maskWords; ++w) touching[i * maskWords + w] = 0;
    if (order[i] >= former) {
      if (order[i] != RowOrigins::kNone && arrived.data) fromArrived(i, order[i] - former);
      return;
    }
    const std::int64_t o = order[i];
    const std::uint32_t oldN = oldCount[o], n = count[i];
    // Both lists ascend in the neighbours' ids: one merge.
    std::uint32_t m = 0;
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::int64_t a = i * grainStride + k * slotStride;
      const std::uint32_t wanted = id[slot[a]];
      while (m < oldN && oldId[oldSlot[o * oldGrainStride + m * oldSlotStride]] < wanted) ++m;
      if (m == oldN) break;
      const std::int64_t b = o * oldGrainStride + m * oldSlotStride;
      if (oldId[oldSlot[b]] != wanted || !(oldTouching[o * oldMaskWords + m / 64] >> (m & 63u) & 1)) continue;
      take(i, k, a, oldHistory + b * width);
    }
  }

private:
  GROUSER_HD void take(int i, std::uint32_t k, std::int64_t a, const void* from) const {
    touching[i * maskWords + k / 64] |= std::uint64_t{1} << (k & 63u);
    if (width) memcpy(history + a * width, from, static_cast<std::size_t>(width) * sizeof(float));
  }

  GROUSER_HD void fromArrived(int i, std::uint32_t row) const {
    const std::uint32_t* data = arrived.data + static_cast<std::uint64_t>(row) * arrived.words();
    const std::uint32_t oldN = data[0], n = count[i];
    std::uint32_t m = 0;
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::int64_t a = i * grainStride + k * slotStride;
      const std::uint32_t wanted = id[slot[a]];
      while (m < oldN && data[1 + m] < wanted) ++m;
      if (m == oldN) break;
      if (data[1 + m] == wanted) take(i, k, a, data + 1 + arrived.capacity + arrived.width * m);
    }
  }
};

GROUSER_HD std::uint32_t bitsSet(std::uint64_t mask) {
  std::uint32_t bits = 0;
  for (; mask; mask &= mask - 1) ++bits;
  return bits;
}

struct CountTouching {
  const std::uint32_t* slots;
  const std::uint64_t* touching;
  std::int64_t maskWords;
  std::uint32_t* out;
  std::uint32_t rows; ///< slots from here on have no row yet
  GROUSER_HD void operator()(int k) const {
    std::uint32_t bits = 0;
    for (std::int64_t w = 0; slots[k] < rows && w < maskWords; ++w) bits += bitsSet(touching[slots[k] * maskWords + w]);
    out[k] = bits;
  }
};

struct ExportRow {
  const std::uint32_t* slots;
  const std::uint32_t *count, *slot, *id;
  const float* history;
  const std::uint64_t* touching;
  std::int64_t grainStride, slotStride, maskWords;
  TravellingRows rows;
  std::uint32_t rowCount;
  GROUSER_HD void operator()(int k) const {
    const std::int64_t i = slots[k];
    std::uint32_t* out = rows.data + static_cast<std::uint64_t>(k) * rows.words();
    std::uint32_t n = 0;
    for (std::uint32_t m = 0; i < rowCount && m < count[i]; ++m) {
      if (!(touching[i * maskWords + m / 64] >> (m & 63u) & 1)) continue;
      const std::int64_t at = i * grainStride + m * slotStride;
      out[1 + n] = id[slot[at]];
      if (rows.width) memcpy(out + 1 + rows.capacity + rows.width * n, history + at * rows.width, rows.width * 4);
      ++n;
    }
    out[0] = n;
  }
};

} // namespace

void CellGrid::setEdge(std::int64_t least) {
  for (int a = 0; a < 3; ++a) {
    edge[a] = least;
    if (!period.along(a)) continue;
    const std::int64_t ring = std::max<std::int64_t>(3, period.length[a] / least);
    edge[a] = period.length[a] / ring, cells[a] = static_cast<std::uint32_t>(ring), low[a] = 0;
  }
}

NeighbourList::NeighbourList(const base::Exec& exec, std::int64_t diameter, std::int64_t skin, int width,
                             const base::Period& period)
    : exec_(exec), diameter_(diameter), skin_(skin), period_(period), width_(width) {
  for (Lists* lists : {&now_, &old_}) {
    lists->count = base::Array<std::uint32_t>(exec);
    lists->slot = base::Array<std::uint32_t>(exec);
    lists->history = base::Array<float>(exec);
    lists->touching = base::Array<std::uint64_t>(exec);
    lists->id = base::Array<std::uint32_t>(exec);
  }
  order_ = base::Array<std::uint32_t>(exec);
  key_ = base::Array<std::uint64_t>(exec);
  cellStart_ = base::Array<std::uint32_t>(exec);
  bounds_ = base::Array<std::uint32_t>(exec, 6);
}

void NeighbourList::sort(const Position* position, std::size_t count) {
  count_ = count;
  const auto n = static_cast<std::int64_t>(count);
  order_.resize(count);
  key_.resize(count);
  // A few grains far away must not make the grid huge: widen its cells until it fits.
  const double most = 16.0 * static_cast<double>(count) + 1e6;
  grid_.period = period_;
  for (std::int64_t edge = diameter_ + skin_;; edge *= 2) {
    grid_.setEdge(edge);
    bounds_.zero();
    base::forEach(exec_, "find grid bounds", (n + kChunk - 1) / kChunk, FindBounds{grid_, position, n, bounds_.data()});
    const std::vector<std::uint32_t> b = bounds_.toHost();
    double all = 1;
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (!period_.along(a)) grid_.low[a] = ~b[k], grid_.cells[a] = b[k + 3] - grid_.low[a] + 1;
      all *= grid_.cells[a];
    }
    if (all <= most) break;
  }
  base::forEach(exec_, "assign cell keys", n, AssignKeys{grid_, position, key_.data()});
  base::iota(exec_, order_.data(), count);
  base::sortByKey(exec_, key_.data(), order_.data(), count);
  const std::int64_t cells = static_cast<std::int64_t>(grid_.cells.x) * grid_.cells.y * grid_.cells.z;
  cellStart_.resize(static_cast<std::size_t>(cells) + 1);
  base::forEach(exec_, "mark cell starts", n + 1, MarkStarts{key_.data(), n, cells, cellStart_.data()});
}

void NeighbourList::allocate(Lists& lists, std::size_t count) const {
  const std::size_t entries = count * capacity_;
  lists.count.resize(count);
  lists.slot.resize(entries);
  lists.history.resize(entries * static_cast<std::size_t>(width_));
  lists.maskWords = (capacity_ + 63) / 64;
  lists.touching.resize(count * static_cast<std::size_t>(lists.maskWords));
  lists.id.resize(count);
  // Grain by grain on the CPU (one cache line a list), slot by slot on the GPU (coalesced).
  lists.grainStride = exec_.onCpu() ? capacity_ : 1;
  lists.slotStride = exec_.onCpu() ? 1 : static_cast<std::int64_t>(count);
}

void NeighbourList::build(const Position* position, const std::uint32_t* id, const RowOrigins* origins,
                          const RadiiInW& radii) {
  const auto n = static_cast<std::int64_t>(count_);
  std::swap(now_, old_);
  for (;;) {
    allocate(now_, count_);
    base::forEach(exec_, "collect neighbours", n,
                  Collect{grid_, position, id, cellStart_.data(), (diameter_ + skin_) * (diameter_ + skin_), capacity_,
                          now_.count.data(), now_.slot.data(), now_.grainStride, now_.slotStride,
                          origins ? origins->ghost : nullptr, radii, skin_});
    const std::uint32_t most = base::maximum(exec_, now_.count.data(), count_);
    if (most <= capacity_) break;
    const std::uint32_t limit = radii.sphere ? kMostOthers : kMostEqual;
    if (most > limit)
      throw base::SimulationError("a grain has " + std::to_string(most) + " neighbours within reach, more than " +
                                  std::to_string(limit) + ": the bed has collapsed into itself" +
                                  (radii.sphere ? ", or its radii are too unlike; use stiffer grains, a smaller time "
                                                  "step, a smaller skin or larger small grains"
                                                : "; use a smaller time step or stiffer grains"));
    capacity_ = std::min(limit, (most + 7) / 8 * 8);
  }
  base::copyOnDevice(exec_, now_.id.data(), id, count_ * sizeof(std::uint32_t));
  if (haveOld_) {
    base::forEach(exec_, "carry contact history", n,
                  CarryHistory{origins ? origins->origin : order_.data(),
                               id,
                               now_.count.data(),
                               now_.slot.data(),
                               now_.grainStride,
                               now_.slotStride,
                               now_.maskWords,
                               width_,
                               now_.history.data(),
                               now_.touching.data(),
                               old_.count.data(),
                               old_.slot.data(),
                               old_.id.data(),
                               old_.history.data(),
                               old_.touching.data(),
                               old_.grainStride,
                               old_.slotStride,
                               old_.maskWords,
                               static_cast<std::uint32_t>(old_.count.size()),
                               origins ? origins->arrived : TravellingRows{}});
  } else {
    now_.touching.zero();
    haveOld_ = true;
  }
}

std::uint32_t NeighbourList::mostTouching(const std::uint32_t* slots, std::size_t count) const {
  if (!haveOld_ || count == 0) return 0;
  base::Array<std::uint32_t> bits(exec_, count);
  base::forEach(exec_, "count neighbours in touch", static_cast<std::int64_t>(count),
                CountTouching{slots, now_.touching.data(), now_.maskWords, bits.data(), rows()});
  return base::maximum(exec_, bits.data(), count);
}

void NeighbourList::exportRows(const std::uint32_t* slots, std::size_t count, const TravellingRows& travelling) const {
  if (!haveOld_) return;
  base::forEach(exec_, "export rows", static_cast<std::int64_t>(count),
                ExportRow{slots, now_.count.data(), now_.slot.data(), now_.id.data(), now_.history.data(),
                          now_.touching.data(), now_.grainStride, now_.slotStride, now_.maskWords, travelling, rows()});
}

NeighbourView NeighbourList::view() {
  return {now_.count.data(), now_.slot.data(), now_.history.data(), now_.touching.data(),
          now_.grainStride,  now_.slotStride,  now_.maskWords};
}

std::size_t NeighbourList::bytes() const {
  std::size_t total = order_.bytes() + key_.bytes() + cellStart_.bytes();
  for (const Lists* lists : {&now_, &old_})
    total += lists->count.bytes() + lists->slot.bytes() + lists->history.bytes() + lists->touching.bytes() +
             lists->id.bytes();
  return total;
}

NeighbourList::HostCopy NeighbourList::toHost() const {
  return {now_.count.toHost(), now_.slot.toHost(), now_.history.toHost(), now_.touching.toHost(),
          now_.grainStride,    now_.slotStride,    now_.maskWords};
}

void NeighbourList::setHistory(const HostCopy& copy) {
  now_.touching.assign(copy.touching);
  if (width_) now_.history.assign(copy.history);
}

} // namespace grouser::contact

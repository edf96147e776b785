// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/motion.hpp"

#include <cmath>
#include <cstdint>

/// Kernel views of a neighbour list, and inputs of its build.
namespace grouser::contact {

/// Layout of rows, one per grain slot: place k of row i is start[i] + k stride. On a CPU rows are contiguous; on a GPU
/// the rows of 32 slots are interleaved, so that a warp reads its k-th places in one access.
struct NeighbourRows {
  const std::uint32_t* start;
  std::int64_t stride;
  GROUSER_HD std::int64_t at(int i, std::uint32_t k) const { return start[i] + k * stride; }
};

/// Kernel view of the list: for each grain slot i the slots of its neighbours, in ascending order of their global ids,
/// each with `width` history values. Bit k of the mask at touching[i * maskWords] marks contact with slot k in the last
/// step. CPU kernels may read slots in groups of eight: entries after a row's end are valid slots.
struct NeighbourView : NeighbourRows {
  const std::uint32_t *count, *slot;
  const std::uint32_t* reach; ///< by place: sum of both radii [units]; null for equal spheres
  float* history;             ///< null without history
  std::uint64_t* touching;
  std::int64_t maskWords; ///< 1 for equal spheres
};

/// Rows received with migrated grains. Each row has `words(capacity)` words: the number of contacts, `capacity`
/// neighbour ids (ascending), and `capacity` histories of `width` numbers.
struct TravellingRows {
  std::uint32_t* data;
  std::uint32_t capacity;
  std::uint32_t width;
  GROUSER_HD std::uint32_t words() const { return 1 + capacity * (1 + width); }
};

/// Sphere radii by slot, stored in the `w` of the velocities [m], each a whole number of length units; negative for
/// fixed spheres.
struct RadiiInW {
  const Motion* sphere = nullptr; ///< null: all spheres have the list's diameter
  float unitsPerLength = 0;       ///< a power of two
  const Motion* fixed = nullptr;  ///< by slot, w < 0: fixed, needs no row; null if all may move
  GROUSER_HD std::int64_t units(int i) const {
    return static_cast<std::int64_t>(fabsf(sphere[i].velocity.w) * unitsPerLength);
  }
  GROUSER_HD bool isFixed(int i) const { return fixed && fixed[i].velocity.w < 0; }
};

/// Origins of the rows of a list, with several ranks.
struct RowOrigins {
  static constexpr std::uint32_t kNone = ~0u;
  const std::uint32_t* origin; ///< by new slot: row of the previous list, or rows() + place in `arrived`, or kNone
  const std::uint32_t* ghost;  ///< by new slot: nonzero for a grain that needs no row
  TravellingRows arrived;
};

} // namespace grouser::contact

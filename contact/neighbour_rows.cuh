// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/for_each.cuh"
#include "contact/neighbour_view.hpp"

#include <cstring>

/// Layout of neighbour rows, and transfer of contact history from one list to the next.
namespace grouser::contact {

/// Number of rows per slice: rows read by one warp of the GPU are interleaved and padded to the longest.
constexpr int kSlice = 32;

struct LongestOfSlice {
  const std::uint32_t* count;
  std::int64_t rows;
  std::uint32_t* longest;
  GROUSER_HD void operator()(int s) const {
    std::uint32_t most = 0;
    for (std::int64_t i = std::int64_t{kSlice} * s; i < rows && i < std::int64_t{kSlice} * (s + 1); ++i)
      most = count[i] > most ? count[i] : most;
    longest[s] = most;
  }
};

struct StartInSlice {
  const std::uint32_t* sliceStart; ///< start of each slice / kSlice
  std::uint32_t* start;
  GROUSER_HD void operator()(int i) const { start[i] = sliceStart[i / kSlice] * kSlice + i % kSlice; }
};

/// Rows of a list, for kernels that only read contacts.
struct TouchingRows {
  NeighbourRows rows;
  const std::uint32_t *count, *slot, *id; ///< id by slot, at the time of build()
  const float* history;
  const std::uint64_t* touching;
  std::int64_t maskWords;
  std::uint32_t rowCount; ///< slots at or above this have no row yet
  int width;

  GROUSER_HD std::uint32_t contactsOf(std::uint32_t i) const {
    std::uint32_t bits = 0;
    for (std::int64_t w = 0; i < rowCount && w < maskWords; ++w) bits += base::bitsSet(touching[i * maskWords + w]);
    return bits;
  }
  /// Copies ids (ascending) and histories of the touching neighbours of slot `i`. Returns their number.
  GROUSER_HD std::uint32_t copy(std::uint32_t i, std::uint32_t* ids, void* histories) const {
    std::uint32_t n = 0;
    const std::size_t size = static_cast<std::size_t>(width) * sizeof(float);
    for (std::uint32_t k = 0; i < rowCount && k < count[i]; ++k) {
      if (!(touching[i * maskWords + k / 64] >> (k & 63u) & 1)) continue;
      const std::int64_t at = rows.at(static_cast<int>(i), k);
      ids[n] = id[slot[at]];
      if (size) memcpy(static_cast<char*>(histories) + n * size, history + at * width, size);
      ++n;
    }
    return n;
  }
};

struct CountTouching {
  TouchingRows from;
  const std::uint32_t* slots; ///< null: all
  std::uint32_t* out;
  GROUSER_HD void operator()(int k) const {
    out[k] = from.contactsOf(slots ? slots[k] : static_cast<std::uint32_t>(k));
  }
};

struct ExportRow {
  TouchingRows from;
  const std::uint32_t* slots;
  TravellingRows to;
  GROUSER_HD void operator()(int k) const {
    std::uint32_t* out = to.data + static_cast<std::uint64_t>(k) * to.words();
    out[0] = from.copy(slots[k], out + 1, out + 1 + to.capacity);
  }
};

/// Contacts of a list, cached while the next list is built in the same memory: rows stored consecutively.
struct ContactCache {
  std::uint32_t* start; ///< [rows + 1]
  std::uint32_t* id;
  float* history; ///< [contact][width]
};

struct KeepRow {
  static constexpr double kNanoseconds = 20;
  TouchingRows from;
  ContactCache to;
  GROUSER_HD void operator()(int i) const {
    from.copy(static_cast<std::uint32_t>(i), to.id + to.start[i],
              to.history + static_cast<std::int64_t>(to.start[i]) * from.width);
  }
};

/// Restores the history of pairs that touched in the previous list.
struct RestoreHistory {
  static constexpr double kNanoseconds = 60;
  const std::uint32_t* origin; ///< previous row of each new slot, or as in RowOrigins
  const std::uint32_t *id, *count, *slot;
  NeighbourRows rows;
  std::int64_t maskWords;
  int width; ///< history values per contact
  float* history;
  std::uint64_t* touching;
  ContactCache kept;
  std::uint32_t former; ///< number of rows in the previous list; higher indices refer to `arrived`
  TravellingRows arrived;

  GROUSER_HD void operator()(int i) const {
    for (std::int64_t w = 0; w < maskWords; ++w) touching[i * maskWords + w] = 0;
    const std::uint32_t o = origin[i];
    if (o < former) {
      const std::uint32_t first = kept.start[o];
      merge(i, kept.start[o + 1] - first, kept.id + first, kept.history + static_cast<std::int64_t>(first) * width);
    } else if (o != RowOrigins::kNone && arrived.data) {
      const std::uint32_t* data = arrived.data + static_cast<std::uint64_t>(o - former) * arrived.words();
      merge(i, data[0], data + 1, data + 1 + arrived.capacity);
    }
  }

private:
  /// Merges two lists sorted by neighbour id.
  GROUSER_HD void merge(int i, std::uint32_t contacts, const std::uint32_t* ids, const void* histories) const {
    const std::size_t size = static_cast<std::size_t>(width) * sizeof(float);
    const std::uint32_t n = count[i];
    std::uint32_t m = 0;
    for (std::uint32_t k = 0; k < n && m < contacts; ++k) {
      const std::int64_t at = rows.at(i, k);
      const std::uint32_t wanted = id[slot[at]];
      while (m < contacts && ids[m] < wanted) ++m;
      if (m == contacts || ids[m] != wanted) continue;
      touching[i * maskWords + k / 64] |= std::uint64_t{1} << (k & 63u);
      if (size) memcpy(history + at * width, static_cast<const char*>(histories) + m * size, size);
    }
  }
};

} // namespace grouser::contact

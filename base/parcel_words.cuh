// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"
#include "base/parcel.hpp"

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>

namespace grouser::base {

/// Kernel view of the parcels as one sequence of 8-byte words.
struct ParcelWords {
  std::uint64_t* to[kMaxParcels];
  const std::uint64_t* from[kMaxParcels];
  std::int64_t end[kMaxParcels]; ///< number of words in this and all preceding parcels

  explicit ParcelWords(std::span<const Parcel> parcels) {
    constexpr std::size_t kWord = sizeof(std::uint64_t);
    if (parcels.size() > kMaxParcels) throw std::logic_error("carry: more than four parcels");
    std::int64_t all = 0;
    for (std::size_t k = 0; k < kMaxParcels; ++k) {
      const Parcel parcel = k < parcels.size() ? parcels[k] : Parcel{nullptr, nullptr, 0};
      if (parcel.bytes % kWord != 0) throw std::logic_error("carry: a size is not a multiple of eight bytes");
      to[k] = static_cast<std::uint64_t*>(parcel.to), from[k] = static_cast<const std::uint64_t*>(parcel.from);
      end[k] = all += static_cast<std::int64_t>(parcel.bytes / kWord);
    }
  }
  GROUSER_HD std::int64_t count() const { return end[kMaxParcels - 1]; }

  GROUSER_HD std::uint64_t read(std::int64_t i) const {
    const Place at = placeOf(i);
    return from[at.parcel] ? from[at.parcel][at.word] : 0;
  }
  GROUSER_HD void write(std::int64_t i, std::uint64_t value) const {
    const Place at = placeOf(i);
    to[at.parcel][at.word] = value;
  }
  GROUSER_HD void operator()(std::int64_t i) const { write(i, read(i)); }
  void onHost() const {
    std::int64_t begin = 0;
    for (std::size_t k = 0; k < kMaxParcels; begin = end[k++]) {
      const auto bytes = static_cast<std::size_t>(end[k] - begin) * sizeof(std::uint64_t);
      if (bytes == 0) continue;
      if (from[k])
        std::memcpy(to[k], from[k], bytes);
      else
        std::memset(to[k], 0, bytes);
    }
  }

private:
  struct Place {
    std::size_t parcel;
    std::int64_t word;
  };
  GROUSER_HD Place placeOf(std::int64_t i) const {
    std::size_t k = 0;
    while (k + 1 < kMaxParcels && i >= end[k]) ++k;
    return {k, k == 0 ? i : i - end[k - 1]};
  }
};

} // namespace grouser::base

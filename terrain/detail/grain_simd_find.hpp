// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/detail/grain_simd_books.hpp"

#include <algorithm>

namespace grouser::terrain::detail {

/// Finds the contacts of a block of grains, several candidates at a time. Base class that tests features for GrainSimd.
template <int kWidth, unsigned kFeatures> class ContactBlock {
protected:
  static constexpr int kGrains = 64, kContacts = 192; ///< sizes of a block
  static constexpr int kFound = kWidth < 8 ? 4 : 8;   ///< candidates tested at once
  using Found = Simd<std::int32_t, kFound>;
  using FoundFloat = Simd<float, kFound>;

  GROUSER_SIMD explicit ContactBlock(const GrainKernelData& data) : data_(data) {}

  GROUSER_SIMD bool has(unsigned feature) const { return hasFeature<kFeatures>(data_, feature); }
  GROUSER_SIMD bool hasHistory() const {
    return has(contact::kFriction | contact::kRollingFriction | contact::kPlastic);
  }
  GROUSER_SIMD bool slips() const { return has(contact::kHertz) && has(contact::kFriction) && has(kLedger); }
  GROUSER_SIMD bool bothSpins() const { return has(contact::kRollingFriction | kManyRadii); } ///< false: their sum
  GROUSER_SIMD unsigned layout() const { return kFeatures & contact::kGeneral ? data_.features : kFeatures; }
  GROUSER_SIMD std::size_t historyWidth() const { return contact::historyWidth(layout()); }
  GROUSER_SIMD std::size_t dentPlace() const { return contact::plasticPlace(layout()); }

  // Tested at run time, once per grain or group of contacts.
  GROUSER_SIMD bool hasFixed() const { return data_.features & kFixed; }
  GROUSER_SIMD bool periodic() const { return data_.features & kPeriodic; }
  GROUSER_SIMD int slotOf(int k) const { return data_.active ? static_cast<int>(data_.active[k]) : k; }
  GROUSER_SIMD bool stays(int i) const { return hasFixed() && data_.motion[i].velocity.w < 0; }
  GROUSER_SIMD int candidatesOf(int k) const {
    const int i = slotOf(k);
    return stays(i) ? 0 : static_cast<int>(data_.neighbours.count[i]);
  }

  /// History of an entry of the neighbour list.
  GROUSER_SIMD float* springOf(std::uint32_t entry) const {
    return data_.neighbours.history + historyWidth() * std::size_t{entry};
  }

  /// Appends the contacts of the k-th grain to the block; does nothing for a fixed grain.
  GROUSER_SIMD void find(int k) {
    const int i = slotOf(k), n = candidatesOf(k);
    begin_[grains_] = contacts_;
    samePlace_[grains_] = atSide_[grains_] = false;
    if (stays(i)) return void(++grains_);
    const std::uint32_t row = data_.neighbours.start[i]; // its entries are consecutive
    const std::uint32_t* const slot = data_.neighbours.slot + row;
    const Int4 p = load<Int4>(data_.position + i);
    const std::uint32_t* const reach = has(kManyRadii) ? data_.neighbours.reach + row : nullptr;
    const bool atSide = periodic() && isAtSide(p);
    auto reach2 = base::broadcast<FoundFloat>(static_cast<float>(data_.diameterUnits2));
    Found lane;
    for (int l = 0; l < kFound; ++l) lane[l] = l;

    std::uint64_t now = 0;
    int c = contacts_;
    atSide_[grains_] = atSide;
    std::uint64_t* before = data_.neighbours.touching + (has(kManyRadii) ? i * data_.neighbours.maskWords : i);
    for (int m = 0; m < n; m += kFound) {
      Found other[4];
      base::gatherRows<kFound>(data_.position, slot + m, other);
      const auto x = base::convert<float>(other[0] - p[0]);
      const auto y = base::convert<float>(other[1] - p[1]);
      const auto z = base::convert<float>(other[2] - p[2]);
      const auto distance2 = x * x + y * y + z * z;
      const unsigned inRow = n - m < kFound ? (1u << (n - m)) - 1 : (1u << kFound) - 1;
      if (has(kManyRadii)) {
        const auto units = base::convert<float>(load<Found>(reach + m));
        reach2 = units * units;
      }
      // Float rounds squared distances up to 5 times, by 3e-7 in total: outside this margin the comparison is certain.
      const auto surely2 = reach2 * (1 - 2e-6f), perhaps2 = reach2 * (1 + 2e-6f);
      const auto open = ((distance2 < perhaps2) & (distance2 >= surely2)) | (distance2 == 0.0f);
      unsigned touching = base::laneBits(distance2 < surely2) & inRow;
      if (const unsigned undecided = (atSide ? ~0u : base::laneBits(open)) & inRow) [[unlikely]]
        touching = decide(i, slot + m, has(kManyRadii) ? reach + m : reach, touching, undecided);
      base::storeMarked(other_ + c, load<Found>(slot + m), touching);
      base::storeMarked(entry_ + c, lane + static_cast<std::int32_t>(row + m), touching);
      store(grain_ + c, Found{} + i);
      now |= std::uint64_t{touching} << m % 64;
      c += __builtin_popcount(touching);
      if (has(kManyRadii) && (m + kFound) % 64 == 0 && m + kFound < n) { // a word of bits is full
        begin(*before, now, row + static_cast<std::uint32_t>(m / 64 * 64));
        *before++ = now, now = 0;
      }
    }
    begin(*before, now, row + static_cast<std::uint32_t>(n > 0 ? (n - 1) / 64 * 64 : 0));
    *before = now;
    contacts_ = c;
    ++grains_;
  }
  /// Resets the springs of new contacts. Bit k corresponds to entry `first` + k.
  GROUSER_SIMD void begin(std::uint64_t before, std::uint64_t now, std::uint32_t first) const {
    if (!hasHistory()) return;
    for (std::uint64_t begun = now & ~before; begun != 0; begun &= begun - 1) {
      float* const spring = springOf(first + static_cast<std::uint32_t>(__builtin_ctzll(begun)));
      base::store3(spring, Float4{});
      if (has(contact::kRollingFriction)) base::store3(spring + 3, Float4{});
      if (has(contact::kPlastic)) spring[dentPlace()] = spring[dentPlace() + 1] = 0;
    }
  }

  /// Corrects the bits of `touching` that are set in `open`, using exact squares.
  GROUSER_SIMD unsigned decide(int i, const std::uint32_t* slot, const std::uint32_t* reach, unsigned touching,
                               unsigned open) {
    for (; open != 0; open &= open - 1) {
      const int l = __builtin_ctz(open);
      const std::int64_t distance2 = squareOf(apart(i, slot[l]));
      touching &= ~(1u << l);
      if (distance2 == 0)
        samePlace_[grains_] = true;
      else if (distance2 < (reach ? std::int64_t{reach[l]} * reach[l] : data_.diameterUnits2))
        touching |= 1u << l;
    }
    return touching;
  }
  /// Vector from i to the nearest image of j.
  GROUSER_SIMD Int4 apart(std::uint32_t i, std::uint32_t j) const {
    if (!periodic()) return load<Int4>(data_.position + j) - load<Int4>(data_.position + i);
    const base::Vec3l way = data_.period.apart(data_.position[i], data_.position[j]);
    return Int4{static_cast<std::int32_t>(way.x), static_cast<std::int32_t>(way.y), static_cast<std::int32_t>(way.z),
                0};
  }
  /// True if a neighbour of a grain at `place` may be across a periodic boundary.
  GROUSER_SIMD bool isAtSide(const Int4& place) const {
    const base::Vec3l u = base::toUnits(base::bitsAs<base::Position>(place));
    const auto skin = static_cast<std::int64_t>(2 * __builtin_sqrt(static_cast<double>(data_.halfSkinUnits2))) + 2;
    const std::int64_t near = data_.diameterUnits + 2 * skin;
    bool atSide = false;
    for (int a = 0; a < 2; ++a)
      if (const std::int64_t in = u[a] - data_.period.low[a]; data_.period.along(a))
        atSide = atSide || in < near || in >= data_.period.length[a] - near;
    return atSide;
  }
  GROUSER_SIMD static std::int64_t squareOf(const Int4& v) {
    const std::int64_t x = v[0], y = v[1], z = v[2];
    return x * x + y * y + z * z;
  }

  const GrainKernelData& data_;
  int grains_ = 0, contacts_ = 0;
  int begin_[kGrains + 1];
  bool samePlace_[kGrains], atSide_[kGrains];
  // Contacts of the block, padded for reads and writes of the last lanes.
  static constexpr int kRows = kContacts + std::max(8, kWidth);
  std::uint32_t grain_[kRows], other_[kRows], entry_[kRows]; ///< slots of both grains; entry in the neighbour list
};

} // namespace grouser::terrain::detail

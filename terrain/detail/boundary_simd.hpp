// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd_rows.hpp"
#include "terrain/detail/grain_simd_books.hpp"
#include "terrain/grain_simd.hpp"

namespace grouser::terrain::detail {

/// SIMD version of BoundaryContacts for equal grains of one material, planes at rest and the linear law. For each wall
/// it finds the grains in contact, then evaluates the law. Walls are summed in the order of BoundaryContacts.
template <int kWidth, unsigned kFeatures> class BoundarySimd {
public:
  GROUSER_SIMD BoundarySimd(const GrainKernelData& data, const ForceData<float>& forces)
      : data_(data), forces_(forces) {}

  /// Processes places [first, last) of the list of grains near boundaries.
  GROUSER_SIMD void run(int first, int last) {
    for (int k = first; k < last; k += kGrains) block(k, last - k < kGrains ? last - k : kGrains);
  }
  GROUSER_SIMD WallAccumulator accumulator() const {
    WallAccumulator accumulator;
    for (int l = 0; l < kLanes; ++l) {
      accumulator.add(kDashpotDissipation, damped_[l]), accumulator.add(kSlidingDissipation, rubbed_[l]);
      for (int a = 0; a < 3; ++a)
        accumulator.add(kWallForce + a, pushed_[a][l]), accumulator.add(kWallTorque + a, twisted_[a][l]);
    }
    return accumulator;
  }

private:
  static constexpr bool kWithFriction = kFeatures & contact::kFriction, kWithLedger = kFeatures & kLedger;
  static constexpr int kLanes = kWidth < 16 ? 4 : 8; ///< lanes in double precision
  static constexpr int kGrains = 64;                 ///< grains per block
  using Float = Simd<float, kWidth>;
  using Bits = Simd<std::int32_t, kWidth>;
  using Vec = base::Vec3<Float>;
  using Int = Simd<std::int32_t, kLanes>;
  using Long = Simd<std::int64_t, kLanes>;
  using Double = Simd<double, kLanes>;
  using Single = Simd<float, kLanes>;

  GROUSER_SIMD void block(int k, int grains) {
    first_ = k;
    for (int g = 0; g < kGrains; ++g) {
      slot_[g] = data_.nearBoundary[k + (g < grains ? g : 0)], now_[g] = 0;
      before_[g] = static_cast<std::int32_t>(data_.boundaryContactMask[slot_[g]]);
      force_[g] = torque_[g] = Float4{}, deepest_[g] = 0;
    }
    place(grains);
    for (int b = 0; b < data_.wallCount; ++b) {
      const int touching = find(b, grains);
      for (int c = 0; c < touching; c += kWidth) touch(b, c, touching - c < kWidth ? touching - c : kWidth);
    }
    if (kWithLedger) account(grains);
    for (int g = 0; g < grains; ++g) {
      if (now_[g] != before_[g]) data_.boundaryContactMask[slot_[g]] = static_cast<std::uint32_t>(now_[g]);
      BoundaryLoad<float>& load = forces_.boundaryLoads[k + g];
      base::store3(&load.force, force_[g]), base::store3(&load.torque, torque_[g]);
      load.deepest = deepest_[g];
    }
  }

  /// Positions of the grains [m].
  GROUSER_SIMD void place(int grains) {
    for (int g = 0; g < grains; g += kLanes) {
      Int row[4];
      base::gatherRows<kLanes>(data_.position, slot_ + g, row);
      for (int a = 0; a < 3; ++a) store(x_[a] + g, exactly(axisOf(row[a], row[3], a)) * data_.unitLength);
    }
  }

  /// Lists the grains in contact with wall b; returns their number.
  GROUSER_SIMD int find(int b, int grains) {
    const Wall& wall = data_.walls[b];
    const auto radius = static_cast<double>(forces_.radius);
    Int lane;
    for (int l = 0; l < kLanes; ++l) lane[l] = l;
    int found = 0;
    for (int g = 0; g < grains; g += kLanes) {
      const Double x = load<Double>(x_[0] + g), y = load<Double>(x_[1] + g), z = load<Double>(x_[2] + g);
      const Double distance = wall.normal.x * x + wall.normal.y * y + wall.normal.z * z - wall.offset;
      const Single overlap = base::toFloat(radius - distance);
      const unsigned inBlock = grains - g < kLanes ? (1u << (grains - g)) - 1 : (1u << kLanes) - 1;
      const unsigned touching = base::laneBits(~(overlap <= 0.0f)) & inBlock;
      if (touching == 0) continue;
      base::storeMarked(grain_ + found, lane + g, touching);
      base::storeMarked(overlap_ + found, overlap, touching);
      found += __builtin_popcount(touching);
    }
    for (int c = found; c < found + kWidth; ++c) grain_[c] = 0, overlap_[c] = forces_.radius; // unused lanes
    return found;
  }

  /// Same as BoundaryContacts::touchFixed() for `count` contacts, starting at c.
  GROUSER_SIMD void touch(int b, int c, int count) {
    std::uint32_t slots[kWidth];
    for (int l = 0; l < kWidth; ++l) slots[l] = slot_[grain_[c + l]];
    Bits bits[4];
    const auto three = [&bits] {
      return Vec{base::bitsAs<Float>(bits[0]), base::bitsAs<Float>(bits[1]), base::bitsAs<Float>(bits[2])};
    };
    base::gatherRows<kWidth, sizeof(contact::Motion)>(&data_.motion->velocity, slots, bits);
    const Vec v = three();
    base::gatherRows<kWidth, sizeof(contact::Motion)>(&data_.motion->spin, slots, bits);
    const Vec w = three();
    Vec shear{};
    if (kWithFriction) {
      for (int l = 0; l < count; ++l)
        spring_[l] = before_[grain_[c + l]] >> b & 1 ? base::load3(historyOf(grain_[c + l], b)) : Float4{};
      base::gatherRows<kWidth>(spring_, kPlaces, bits);
      shear = three();
    }
    const base::Vec3d& outward = data_.walls[b].normal;
    const Vec normal = base::broadcast<Float>(-outward.as<float>());
    const auto overlap = load<Float>(overlap_ + c);
    const Vec arm = normal * (forces_.radius - overlap);
    const contact::BasicContactGeometry<Float> touch{normal, overlap, v + cross(w, arm),
                                                     base::broadcast<Float>(forces_.mass),
                                                     base::broadcast<Float>(forces_.radius)};
    const auto reaction = contact::contactForce<kFeatures & contact::kFriction>(
        forces_.boundaryLaws[b * data_.materials], touch, forces_.timeStep, shear);
    const Vec torque = cross(arm, reaction.force);
    Float forces[4] = {reaction.force.x, reaction.force.y, reaction.force.z, reaction.damped};
    Float torques[4] = {torque.x, torque.y, torque.z, reaction.rubbed};
    Float springs[4] = {shear.x, shear.y, shear.z, Float{}};
    storeAll(reacted_, forces), storeAll(turned_, torques);
    if (kWithFriction) storeAll(spring_, springs);
    for (int l = 0; l < count; ++l) {
      const int g = grain_[c + l];
      now_[g] |= 1 << b;
      force_[g] += reacted_[l];
      if (kWithFriction) torque_[g] += turned_[l], base::store3(historyOf(g, b), spring_[l]);
      if (overlap_[c + l] > deepest_[g]) deepest_[g] = overlap_[c + l];
    }
  }
  GROUSER_SIMD float* historyOf(std::int32_t grain, int b) const {
    const std::int64_t place = std::int64_t{first_} + grain;
    return data_.boundaryHistory + (place * data_.boundaryCount + b) * contact::historyWidth(kFeatures);
  }
  /// Stores vector components as rows, in lane order.
  GROUSER_SIMD static void storeAll(Float4* rows, Float (&in)[4]) {
    base::transpose(in);
    for (int l = 0; l < kWidth; ++l) {
      Float4 row;
      for (int k = 0; k < 4; ++k) row[k] = in[l % 4][l / 4 * 4 + k];
      rows[l] = row;
    }
  }

  /// Same as BoundaryContacts::accountWalls() and accountDissipation().
  GROUSER_SIMD void account(int grains) {
    const LedgerScale& scale = data_.ledgerScale;
    for (int g = 0; g < grains; g += kLanes) {
      Int lane;
      for (int l = 0; l < kLanes; ++l) lane[l] = l;
      const Long which = base::convert<std::int64_t>((load<Int>(now_ + g) != 0) & (lane < grains - g));
      Int rows[4];
      base::gatherRows<kLanes>(force_ + g, kPlaces, rows);
      Double force[4], torque[4];
      for (int a = 0; a < 4; ++a) force[a] = base::toDouble(base::bitsAs<Single>(rows[a]));
      base::gatherRows<kLanes>(torque_ + g, kPlaces, rows);
      for (int a = 0; a < 4; ++a) torque[a] = base::toDouble(base::bitsAs<Single>(rows[a]));
      const base::Vec3<Double> x{load<Double>(x_[0] + g), load<Double>(x_[1] + g), load<Double>(x_[2] + g)};
      const base::Vec3<Double> f{force[0], force[1], force[2]};
      const base::Vec3<Double> about = cross(x, f) + base::Vec3<Double>{torque[0], torque[1], torque[2]};
      for (int a = 0; a < 3; ++a) {
        pushed_[a] += wholeOf(scale.perForce * f[a]) & which;
        twisted_[a] += wholeOf(scale.perTorque * about[a]) & which;
      }
      damped_ += wholeOf(scale.perEnergy * force[3]) & which;
      if (kWithFriction) rubbed_ += wholeOf(scale.perEnergy * torque[3]) & which;
    }
  }

  static constexpr std::uint32_t kPlaces[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const GrainKernelData& data_;
  const ForceData<float>& forces_;
  Long damped_{}, rubbed_{}, pushed_[3] = {}, twisted_[3] = {};
  // Grains of the block.
  int first_ = 0; ///< list index of its first grain
  std::uint32_t slot_[kGrains];
  std::int32_t now_[kGrains], before_[kGrains]; ///< bit mask of walls in contact
  double x_[3][kGrains];
  Float4 force_[kGrains], torque_[kGrains]; ///< fourth numbers: damped, rubbed
  float deepest_[kGrains];
  // Grains in contact with one wall; lanes may write beyond the end.
  std::int32_t grain_[kGrains + 16];
  float overlap_[kGrains + 16];
  Float4 spring_[kWidth] = {}, reacted_[kWidth], turned_[kWidth];
};

template <int kWidth, unsigned kFeatures>
GROUSER_SIMD void runWallsOf(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  BoundarySimd<kWidth, kFeatures> some(d, f);
  some.run(first, last);
  if (kFeatures & kLedger) addToLedger(d, first, some.accumulator());
}

template <int kWidth>
GROUSER_SIMD void runWalls(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  if (d.features & contact::kFriction)
    d.ledgerSums ? runWallsOf<kWidth, contact::kFriction | kLedger>(d, f, first, last)
                 : runWallsOf<kWidth, contact::kFriction>(d, f, first, last);
  else
    d.ledgerSums ? runWallsOf<kWidth, kLedger>(d, f, first, last) : runWallsOf<kWidth, 0>(d, f, first, last);
}

} // namespace grouser::terrain::detail

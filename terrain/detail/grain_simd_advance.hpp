// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/detail/grain_simd_books.hpp"
#include "terrain/grain_simd.hpp"

namespace grouser::terrain::detail {

/// GrainStep::advance() for kLanes grains at once, from the contact forces of a block of grains. Operations, numbers
/// and order are identical; unusual grains are passed to GrainStep itself.
template <int kLanes, unsigned kFeatures> class AdvanceLanes {
public:
  static constexpr int kGrains = 64; ///< grains per block
  enum class Way : std::int32_t { lanes, alone, done };

  GROUSER_SIMD AdvanceLanes(const GrainKernelData& data, const ForceData<float>& forces)
      : data_(data), forces_(forces), accumulator_(data) {}

  /// Adds the forces of a grain, in rows of four; fourth numbers: damping loss, and maximum overlap.
  GROUSER_SIMD void add(int g, int slot, const Float4& force, const Float4& torque, float rubbed, float rolled,
                        float slipped) {
    const int lane = laneOf(g);
    slot_[lane] = static_cast<std::uint32_t>(slot), way_[lane] = static_cast<std::int32_t>(Way::lanes);
    force_[g] = force, torque_[g] = torque;
    if (has(kLedger)) rubbed_[lane] = rubbed, rolled_[lane] = rolled;
    if (slips()) slipped_[lane] = slipped;
  }
  /// Adds a grain that has already been advanced, or is fixed.
  GROUSER_SIMD void addDone(int g, int slot) {
    const int lane = laneOf(g);
    slot_[lane] = static_cast<std::uint32_t>(slot), way_[lane] = static_cast<std::int32_t>(Way::done);
    force_[g] = torque_[g] = Float4{};
    if (has(kLedger)) rubbed_[lane] = rolled_[lane] = 0;
    if (slips()) slipped_[lane] = 0;
  }
  /// Marks grain g for GrainStep, with this load instead of that of add().
  GROUSER_SIMD void setAlone(int g, const Double4& force, const Double4& torque) {
    way_[laneOf(g)] = static_cast<std::int32_t>(Way::alone), forceAlone_[g] = force, torqueAlone_[g] = torque;
  }

  /// Advances the first `grains` of the block; `rare` accumulates those passed to GrainStep.
  GROUSER_SIMD void run(int grains, GrainAccumulator& rare) {
    for (int g = grains; g % kLanes != 0; ++g) addDone(g, static_cast<int>(slot_[0]));
    for (int g = 0; g < grains; g += kLanes)
      if (const unsigned left = step(g, !data_.active && g + kLanes <= grains); left != 0) [[unlikely]]
        stepAlone(g, left, rare);
  }

  /// Energy accounting of all grains so far, except those passed to GrainStep.
  GROUSER_SIMD const LaneAccumulator<kLanes, kFeatures>& accumulator() const { return accumulator_; }

private:
  static constexpr bool kMaySlip = kFeatures & (contact::kHertz | contact::kGeneral);
  GROUSER_SIMD bool has(unsigned feature) const { return hasFeature<kFeatures>(data_, feature); }
  GROUSER_SIMD bool slips() const { return has(contact::kHertz) && has(contact::kFriction) && has(kLedger); }

  using Float = Simd<float, kLanes>;
  using Int = Simd<std::int32_t, kLanes>;
  using Unsigned = Simd<std::uint32_t, kLanes>;
  using Long = Simd<std::int64_t, kLanes>;
  using Double = Simd<double, kLanes>;
  static constexpr unsigned kAll = (1u << kLanes) - 1;

  // Lane of a grain, in the order defined by loadRows(), and the inverse mapping:
  GROUSER_SIMD static int laneOf(int g) {
    constexpr int kStride = kLanes / 4;
    const int row = g % kLanes;
    return g - row + row % kStride * 4 + row / kStride;
  }
  GROUSER_SIMD static int rowOf(int lane) { return lane % 4 * (kLanes / 4) + lane / 4; }

  // Loads or stores the components of a group's grains, with rows kBytes apart.
  // `together`: the slots of the group are consecutive.
  template <std::size_t kBytes = 16, class V>
  GROUSER_SIMD void loadAll(const void* from, int g, bool together, V (&out)[4]) const {
    if (kBytes == 16 && together) return base::loadRows(static_cast<const Float4*>(from) + slot_[g], out);
    Int rows[4];
    base::gatherRows<kLanes, kBytes>(from, slot_ + g, rows);
    for (int k = 0; k < 4; ++k) out[k] = base::bitsAs<V>(rows[k]);
  }
  template <std::size_t kBytes = 16, class V>
  GROUSER_SIMD void storeAll(void* to, int g, bool together, V (&in)[4], unsigned which) const {
    if (kBytes == 16 && together && which == kAll) return base::storeRows(static_cast<Float4*>(to) + slot_[g], in);
    base::transpose(in);
#pragma GCC unroll 8
    for (int l = 0; l < kLanes; ++l)
      if (which == kAll || which >> l & 1)
        std::memcpy(static_cast<char*>(to) + kBytes * std::size_t{slot_[g + l]},
                    reinterpret_cast<const char*>(&in[l % 4]) + l / 4 * 16, 16);
  }
  static constexpr std::size_t kApart = sizeof(contact::Motion);

  /// addCompensated() in SIMD. Remainders are in units of 2^-39 of the value's binade, a power of two: division equals
  /// multiplication by the inverse, bit for bit.
  struct Compensated {
    Double sum, rounding;
  };
  GROUSER_SIMD static Compensated addCompensated(Float& value, Int& remainder, const Double& increment) {
    const Double sum =
        base::toDouble(value) +
        base::toDouble(remainder) * (base::toDouble(base::bitsAs<Float>(binadeOf(value))) * kRemainderOfBinade) +
        increment;
    value = base::toFloat(sum);
    const Int binade = binadeOf(value);
    const Float perBinade = base::bitsAs<Float>((254 << 23) - binade);
    const Double rest = (sum - base::toDouble(value)) * (base::toDouble(perBinade) * (1 / kRemainderOfBinade));
    remainder = base::clamped(base::toInt(base::roundedDown(rest + 0.5)), kMinRemainder, kMaxRemainder);
    return {sum,
            (base::toDouble(remainder) - rest) * (base::toDouble(base::bitsAs<Float>(binade)) * kRemainderOfBinade)};
  }
  GROUSER_SIMD static Int binadeOf(const Float& v) {
    const Int bits = base::bitsAs<Int>(v) & 0x7F800000, least = base::broadcast<Int>(kMinBinade);
    return bits < least ? least : bits;
  }
  /// SIMD version of halfSquareGained().
  GROUSER_SIMD static Double halfSquareGained(const Double& faster, const Compensated& now) {
    return faster * (now.sum - faster * 0.5) + now.rounding * now.sum;
  }

  /// Constants that depend on the radius.
  struct Sizes {
    Double stepPerMass, stepPerInertia, mass, massShare, inertia;
    Float maxOverlap;
  };
  GROUSER_SIMD Sizes sizesOf(const Float& radius, const Float& material) const {
    if (!has(kManyRadii))
      return {base::broadcast<Double>(data_.stepPerMass), base::broadcast<Double>(data_.stepPerInertia),
              base::broadcast<Double>(data_.mass),        base::broadcast<Double>(1),
              base::broadcast<Double>(data_.inertia),     base::broadcast<Float>(data_.maxOverlap)};
    Float perCube = base::broadcast<Float>(forces_.massPerCube);
    if (has(kManyMaterials))
      for (int l = 0; l < kLanes; ++l)
        perCube[l] = static_cast<float>(data_.massPerCube[static_cast<int>(material[l])]);
    const Double own = base::toDouble(perCube * radius * radius * radius), r = base::toDouble(radius);
    const Double inertia = 0.4 * own * r * r, share = own / data_.mass;
    return {data_.timeStep / own,          data_.timeStep / inertia, data_.mass * share, share, inertia,
            data_.maxOverlapShare * radius};
  }

  /// Advances kLanes grains starting at g; returns the bit mask of those passed to GrainStep.
  GROUSER_SIMD unsigned step(int g, bool together) {
    Float v[4], w[4], force[4], torque[4];
    Int kept[4], p[4], q[4], keep[4];
    loadAll<kApart>(&data_.motion->velocity, g, together, v), loadAll<kApart>(&data_.motion->spin, g, together, w);
    loadAll(data_.remainders, g, together, kept), loadAll(data_.position, g, together, p);
    base::loadRows(force_ + g, force), base::loadRows(torque_ + g, torque);
    const Sizes size = sizesOf(v[3], w[3]);
    const double gravity[3] = {data_.gravityStep.x, data_.gravityStep.y, data_.gravityStep.z};
    Int ordinary = load<Int>(way_ + g) == static_cast<std::int32_t>(Way::lanes);
    ordinary &= ~(torque[3] > size.maxOverlap);
    Double work[3];
    // Without history and parts, torques are zero and spins are constant.
    const bool turns =
        has(contact::kFriction | contact::kRollingFriction | contact::kPlastic) || data_.features & kLoads;
    keep[3] = kept[3] & ~0x3FFFFFFF, q[3] = p[3];
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      Int rv = kept[a] << 16 >> 16, rw = kept[a] >> 16;
      const Double faster = base::toDouble(force[a]) * size.stepPerMass + gravity[a];
      const Double turning = base::toDouble(torque[a]) * size.stepPerInertia;
      const Compensated speed = addCompensated(v[a], rv, faster);
      Compensated turn{};
      if (turns) turn = addCompensated(w[a], rw, turning);
      if (has(kLedger))
        work[a] = halfSquareGained(faster, speed) * size.mass + halfSquareGained(turning, turn) * size.inertia;
      keep[a] = (rv & 0xFFFF) | rw << 16;
      Double displacement = speed.sum * data_.unitsPerSpeed;
      const auto near = (displacement > -kMaxUnitsPerStep) & (displacement < kMaxUnitsPerStep);
      displacement = near ? displacement : Double{}; // a NaN speed must not reach the integer conversion
      // advanceKeeping()
      const Int place = kept[3] << (22 - 10 * a) >> 22; // ten bits each
      const Double wanted = displacement + base::toDouble(place) * (1.0 / kPlacesPerUnit);
      const Double whole = base::roundedDown(wanted + 0.5);
      const Int rest = base::clamped(base::toInt(base::roundedDown((wanted - whole) * double{kPlacesPerUnit} + 0.5)),
                                     kMinPlace, kMaxPlace);
      keep[3] |= (rest & 0x3FF) << (10 * a);
      const Int units = base::toInt(whole);
      q[a] = p[a] + units;
      // The high words change when a low word overflows.
      const Int passes = (base::bitsAs<Unsigned>(q[a]) < base::bitsAs<Unsigned>(p[a])) ^ (units < 0);
      ordinary &= base::convert<std::int32_t>(near) & ~passes;
    }
    const Float speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    ordinary &= (speed2 <= data_.maxSpeed2) & (speed2 < 1e30f);
    const unsigned which = base::laneBits(ordinary);
    if (has(kLedger)) {
      const Double slipped = slips() ? base::toDouble(load<Float>(slipped_ + g)) : Double{};
      accumulator_.add(work,
                       {base::toDouble(force[3]), base::toDouble(load<Float>(rubbed_ + g)),
                        base::toDouble(load<Float>(rolled_ + g)), slipped},
                       p, size.massShare, ordinary);
    }
    raiseWhereStale(g, q, which);
    if (!has(kManyRadii)) v[3] = Float{};
    if (!has(kManyMaterials)) w[3] = Float{};
    storeAll(data_.nextPosition, g, together, q, which), storeAll(data_.remainders, g, together, keep, which);
    storeAll<kApart>(&data_.nextMotion->velocity, g, together, v, which);
    storeAll<kApart>(&data_.nextMotion->spin, g, together, w, which);
    return kAll & ~which;
  }

  /// Marks the list as stale if one of these grains has moved too far since it was listed.
  GROUSER_SIMD void raiseWhereStale(int g, const Int (&q)[4], unsigned which) const {
    Int was[4];
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) {
      const auto row = [&](int l) { return base::bitsAs<Int4>(base::load3(data_.reference + slot_[g + l])); };
      if constexpr (kLanes == 4)
        was[k] = row(k);
      else
        was[k] = __builtin_shufflevector(row(k), row(k + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    }
    base::transpose(was);
    const Double x = base::toDouble(q[0] - was[0]), y = base::toDouble(q[1] - was[1]),
                 z = base::toDouble(q[2] - was[2]);
    // This sum is rounded; within the margin the exact sum below decides.
    const auto perhaps = x * x + y * y + z * z > static_cast<double>(data_.halfSkinUnits2) * (1 - 1e-12);
    unsigned far = base::laneBits(base::convert<std::int32_t>(perhaps)) & which;
    for (; far != 0; far &= far - 1) {
      const int l = __builtin_ctz(far);
      std::int64_t way2 = 0;
      for (int a = 0; a < 3; ++a) {
        const std::int64_t way = q[a][l] - was[a][l];
        way2 += way * way;
      }
      if (way2 > data_.halfSkinUnits2) __atomic_store_n(&data_.flags->stale, 1u, __ATOMIC_RELAXED);
    }
  }

  GROUSER_SIMD void stepAlone(int g, unsigned which, GrainAccumulator& rare) const {
    for (; which != 0; which &= which - 1) {
      const int lane = __builtin_ctz(which), k = g + rowOf(lane), l = g + lane;
      if (way_[l] == static_cast<std::int32_t>(Way::done)) continue;
      const bool alone = way_[l] == static_cast<std::int32_t>(Way::alone);
      const Double4 f = alone ? forceAlone_[k] : base::toDouble(force_[k]),
                    t = alone ? torqueAlone_[k] : base::toDouble(torque_[k]);
      const Lost lost{static_cast<double>(force_[k][3]), has(kLedger) ? double{rubbed_[l]} : 0,
                      has(kLedger) ? double{rolled_[l]} : 0, slips() ? double{slipped_[l]} : 0};
      advanceGrain(data_, forces_, static_cast<int>(slot_[l]), {f[0], f[1], f[2]}, {t[0], t[1], t[2]}, torque_[k][3],
                   lost, rare);
    }
  }

  const GrainKernelData& data_;
  const ForceData<float>& forces_;
  LaneAccumulator<kLanes, kFeatures> accumulator_;
  std::uint32_t slot_[kGrains];
  std::int32_t way_[kGrains];
  alignas(32) Float4 force_[kGrains], torque_[kGrains];
  float rubbed_[kGrains], rolled_[kGrains], slipped_[kMaySlip ? kGrains : 1];
  Double4 forceAlone_[kGrains], torqueAlone_[kGrains];
};

} // namespace grouser::terrain::detail

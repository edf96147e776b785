// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd_rows.hpp"
#include "terrain/grain_kernel_data.cuh"

namespace grouser::base {

#if defined(__AVX512F__)
// Conversions of eight numbers, like those of four in simd_rows.hpp. In masked form, since GCC 12 warns otherwise.
constexpr __mmask8 kEightLanes = 0xFF;
using Float8 = Simd<float, 8>;
using Int8 = Simd<std::int32_t, 8>;
using Double8 = Simd<double, 8>;
GROUSER_SIMD Double8 toDouble(const Float8& v) {
  return bitsAs<Double8>(_mm512_maskz_cvtps_pd(kEightLanes, bitsAs<__m256>(v)));
}
GROUSER_SIMD Double8 toDouble(const Int8& v) {
  return bitsAs<Double8>(_mm512_maskz_cvtepi32_pd(kEightLanes, bitsAs<__m256i>(v)));
}
GROUSER_SIMD Float8 toFloat(const Double8& v) {
  return bitsAs<Float8>(_mm512_maskz_cvtpd_ps(kEightLanes, bitsAs<__m512d>(v)));
}
/// Rounds towards zero.
GROUSER_SIMD Int8 toInt(const Double8& v) {
  return bitsAs<Int8>(_mm512_maskz_cvttpd_epi32(kEightLanes, bitsAs<__m512d>(v)));
}
GROUSER_SIMD Double8 roundedDown(const Double8& v) {
  return bitsAs<Double8>(
      _mm512_maskz_roundscale_pd(kEightLanes, bitsAs<__m512d>(v), _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
}
GROUSER_SIMD Int8 clamped(const Int8& v, int least, int most) {
  const Int8 low = broadcast<Int8>(least), high = broadcast<Int8>(most), below = v < high ? v : high;
  return below > low ? below : low;
}
#endif

} // namespace grouser::base

namespace grouser::terrain::detail {

using base::Double4;
using base::Float4;
using base::Int4;
using base::load;
using base::Simd;
using base::SimdVector;
using base::store;

/// True if the grains have a feature (or one of several): known at compile time except in the general kernel.
template <unsigned kFeatures> GROUSER_SIMD bool hasFeature(const GrainKernelData& d, unsigned feature) {
  return ((kFeatures & contact::kGeneral ? d.features : kFeatures) & feature) != 0;
}

/// SIMD version of wholeQuanta().
template <SimdVector V> GROUSER_SIMD Simd<std::int64_t, base::kWidthOf<V>> wholeOf(V quanta) {
  using Long = Simd<std::int64_t, base::kWidthOf<V>>;
  const V most = base::broadcast<V>(0x1p51), shift = base::broadcast<V>(0x1.8p52);
  quanta = quanta > -most ? quanta : -most;
  quanta = quanta < most ? quanta : most;
  return base::bitsAs<Long>(quanta + shift) - base::bitsAs<Long>(shift);
}
/// SIMD version of base::axisOf().
template <SimdVector V>
GROUSER_SIMD Simd<std::int64_t, base::kWidthOf<V>> axisOf(const V& low, const V& high, int axis) {
  const V top = high << (22 - 10 * axis) >> 22;
  return base::convert<std::int64_t>(top) << 32 |
         base::convert<std::int64_t>(base::bitsAs<Simd<std::uint32_t, base::kWidthOf<V>>>(low));
}
/// Exact conversion to double: coordinates have 42 bits.
template <SimdVector V> GROUSER_SIMD Simd<double, base::kWidthOf<V>> exactly(const V& units) {
  using Double = Simd<double, base::kWidthOf<V>>;
  const Double shift = base::broadcast<Double>(0x1.8p52);
  return base::bitsAs<Double>(units + base::bitsAs<V>(shift)) - shift;
}

/// Energy accounting of kLanes grains at once: GrainStep::account().
template <int kLanes, unsigned kFeatures> class LaneAccumulator {
public:
  using Int = Simd<std::int32_t, kLanes>;
  using Long = Simd<std::int64_t, kLanes>;
  using Double = Simd<double, kLanes>;

  GROUSER_SIMD explicit LaneAccumulator(const GrainKernelData& data) : data_(data) {}

  /// Dissipation of these grains [J].
  struct LostLanes {
    Double damped, rubbed, rolled, slipped;
  };
  /// `work`: per axis; `massShare`: mass / model mass; for the grains in `which`.
  GROUSER_SIMD void add(const Double (&work)[3], const LostLanes& lost, const Int (&place)[4], const Double& massShare,
                        const Int& which) {
    const Long mask = base::convert<std::int64_t>(which);
    const double perEnergy = data_.ledgerScale.perEnergy;
    const Double all = (work[0] + work[2]) + work[1];
    work_ += wholeOf(all * perEnergy) & mask, turnover_ += wholeOf((all < 0.0 ? -all : all) * perEnergy) & mask;
    damped_ += wholeOf(lost.damped * perEnergy) & mask;
    if (has(contact::kFriction)) rubbed_ += wholeOf(lost.rubbed * perEnergy) & mask;
    if (has(contact::kRollingFriction)) rolled_ += wholeOf(lost.rolled * perEnergy) & mask;
    if (has(contact::kHertz)) slipped_ += wholeOf(lost.slipped * perEnergy) & mask;
    if (has(kManyRadii))
      mass_ += wholeOf(massShare * static_cast<double>(kMassQuanta)) & mask;
    else
      mass_ += mask & kMassQuanta;
    for (int a = 0; a < 3; ++a) {
      const Long u = axisOf(place[a], place[3], a);
      moment_[a] += (has(kManyRadii) ? wholeOf(massShare * exactly(u)) : u) & mask;
    }
  }

  /// Adds the sums over all lanes to `accumulator`.
  GROUSER_SIMD void addTo(GrainAccumulator& accumulator) const {
    for (int l = 0; l < kLanes; ++l) {
      accumulator.of[kWork] += work_[l], accumulator.of[kTurnover] += turnover_[l];
      accumulator.of[kDashpotDissipation] += damped_[l], accumulator.of[kSlidingDissipation] += rubbed_[l],
          accumulator.of[kRollingDissipation] += rolled_[l];
      if (has(contact::kHertz)) accumulator.of[kMicroSlipDissipation] += slipped_[l];
      for (int a = 0; a < 3; ++a) accumulator.of[kMoment + a] += moment_[a][l];
      accumulator.of[kMass] += mass_[l];
    }
  }

private:
  GROUSER_SIMD bool has(unsigned feature) const { return hasFeature<kFeatures>(data_, feature); }

  const GrainKernelData& data_;
  Long work_{}, turnover_{}, damped_{}, rubbed_{}, rolled_{}, slipped_{}, mass_{}, moment_[3] = {};
};

} // namespace grouser::terrain::detail

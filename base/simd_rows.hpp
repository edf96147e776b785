// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd.hpp"

#include <utility>

/// Transposes records to SIMD lanes and back: a row contains four numbers of one record, and a vector contains one
/// number of several records.
namespace grouser::base {

using Float4 = Simd<float, 4>;
using Int4 = Simd<std::int32_t, 4>;
using Double4 = Simd<double, 4>;

/// Loads three numbers, in two loads and without a stack copy; a fourth number might be out of bounds.
GROUSER_SIMD Float4 load3(const void* from) {
  std::uint64_t first;
  std::uint32_t last;
  std::memcpy(&first, from, sizeof first);
  std::memcpy(&last, static_cast<const char*>(from) + sizeof first, sizeof last);
  return bitsAs<Float4>(Simd<std::uint64_t, 2>{first, last});
}
GROUSER_SIMD void store3(void* to, const Float4& v) {
  const std::uint64_t first = bitsAs<Simd<std::uint64_t, 2>>(v)[0];
  const float last = v[2];
  std::memcpy(to, &first, sizeof first);
  std::memcpy(static_cast<char*>(to) + sizeof first, &last, sizeof last);
}

// Conversions of four numbers: compilers otherwise convert in pairs.
#if defined(__AVX2__)
GROUSER_SIMD Double4 toDouble(const Float4& v) { return bitsAs<Double4>(_mm256_cvtps_pd(bitsAs<__m128>(v))); }
GROUSER_SIMD Double4 toDouble(const Int4& v) { return bitsAs<Double4>(_mm256_cvtepi32_pd(bitsAs<__m128i>(v))); }
GROUSER_SIMD Float4 toFloat(const Double4& v) { return bitsAs<Float4>(_mm256_cvtpd_ps(bitsAs<__m256d>(v))); }
/// Rounds towards zero.
GROUSER_SIMD Int4 toInt(const Double4& v) { return bitsAs<Int4>(_mm256_cvttpd_epi32(bitsAs<__m256d>(v))); }
GROUSER_SIMD Double4 roundedDown(const Double4& v) { return bitsAs<Double4>(_mm256_floor_pd(bitsAs<__m256d>(v))); }
#else
GROUSER_SIMD Double4 toDouble(const Float4& v) { return convert<double>(v); }
GROUSER_SIMD Double4 toDouble(const Int4& v) { return convert<double>(v); }
GROUSER_SIMD Float4 toFloat(const Double4& v) { return convert<float>(v); }
GROUSER_SIMD Int4 toInt(const Double4& v) { return convert<std::int32_t>(v); }
GROUSER_SIMD Double4 roundedDown(const Double4& v) {
  Double4 r;
  for (int l = 0; l < 4; ++l) r[l] = std::floor(v[l]);
  return r;
}
#endif

GROUSER_SIMD Int4 clamped(const Int4& v, int least, int most) {
  const Int4 low = broadcast<Int4>(least), high = broadcast<Int4>(most), below = v < high ? v : high;
  return below > low ? below : low;
}

/// Stores the lanes selected by `marks` contiguously from `to`; writes up to the full vector width.
template <SimdVector V> GROUSER_SIMD void storeMarked(void* to, const V& v, unsigned marks) {
  static_assert(sizeof v[0] == 4);
#if defined(__AVX512VL__)
  if constexpr (kWidthOf<V> == 16) {
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(marks), bitsAs<__m512i>(v)));
    return;
  } else if constexpr (kWidthOf<V> == 8) {
    _mm256_storeu_si256(static_cast<__m256i*>(to),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(marks), bitsAs<__m256i>(v)));
    return;
  }
#endif
  for (int l = 0; l < kWidthOf<V>; ++l) {
    const auto number = v[l];
    std::memcpy(to, &number, sizeof number);
    to = static_cast<char*>(to) + sizeof number * (marks >> l & 1);
  }
}

namespace detail {

template <SimdVector V, int... kLane> GROUSER_SIMD void transpose(V (&r)[4], std::integer_sequence<int, kLane...>) {
  constexpr int kWidth = sizeof...(kLane);
  if constexpr (sizeof r[0][0] == 4) { // single numbers of two registers, then pairs, within each 16 bytes
    const V a = __builtin_shufflevector(r[0], r[1], (kLane / 4 * 4 + kLane % 4 / 2 + kLane % 2 * kWidth)...);
    const V b = __builtin_shufflevector(r[2], r[3], (kLane / 4 * 4 + kLane % 4 / 2 + kLane % 2 * kWidth)...);
    const V c = __builtin_shufflevector(r[0], r[1], (kLane / 4 * 4 + kLane % 4 / 2 + kLane % 2 * kWidth + 2)...);
    const V d = __builtin_shufflevector(r[2], r[3], (kLane / 4 * 4 + kLane % 4 / 2 + kLane % 2 * kWidth + 2)...);
    r[0] = __builtin_shufflevector(a, b, (kLane / 4 * 4 + kLane % 2 + kLane % 4 / 2 * kWidth)...);
    r[1] = __builtin_shufflevector(a, b, (kLane / 4 * 4 + kLane % 2 + kLane % 4 / 2 * kWidth + 2)...);
    r[2] = __builtin_shufflevector(c, d, (kLane / 4 * 4 + kLane % 2 + kLane % 4 / 2 * kWidth)...);
    r[3] = __builtin_shufflevector(c, d, (kLane / 4 * 4 + kLane % 2 + kLane % 4 / 2 * kWidth + 2)...);
  } else { // within each 16 bytes, then across 16-byte blocks
    static_assert(kWidth == 4);
    const V a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    const V c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7), r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
  }
}

} // namespace detail

/// Transposes each 4 x 4 block of numbers, one block per four lanes; its own inverse.
template <SimdVector V> GROUSER_SIMD void transpose(V (&r)[4]) {
  detail::transpose(r, std::make_integer_sequence<int, kWidthOf<V>>{});
}

/// Loads four numbers of each of kWidth records; the lane order is the same as for `storeRows`.
template <SimdVector V> GROUSER_SIMD void loadRows(const Float4* rows, V (&out)[4]) {
  constexpr int kStride = kWidthOf<V> / 4; // rows per register
#pragma GCC unroll 4
  for (int k = 0; k < 4; ++k) out[k] = load<V>(rows + k * kStride);
  transpose(out);
}
template <SimdVector V> GROUSER_SIMD void storeRows(Float4* rows, V (&in)[4]) {
  transpose(in);
  constexpr int kStride = kWidthOf<V> / 4;
#pragma GCC unroll 4
  for (int k = 0; k < 4; ++k) store(rows + k * kStride, in[k]);
}

/// Loads the first 16 bytes of the records `which` (of kBytes each, at `from`), by component; record which[l] in lane
/// l.
template <int kWidth, std::size_t kBytes = 16>
GROUSER_SIMD void gatherRows(const void* from, const std::uint32_t* which, Simd<std::int32_t, kWidth> (&out)[4]) {
  const auto row = [&](int l) { return load<Int4>(static_cast<const char*>(from) + kBytes * std::size_t{which[l]}); };
  for (int k = 0; k < 4; ++k) {
    if constexpr (kWidth == 4) {
      out[k] = row(k);
    } else {
      const auto pair = __builtin_shufflevector(row(k), row(k + 4), 0, 1, 2, 3, 4, 5, 6, 7);
      if constexpr (kWidth == 8)
        out[k] = pair;
      else
        out[k] = __builtin_shufflevector(pair, __builtin_shufflevector(row(k + 8), row(k + 12), 0, 1, 2, 3, 4, 5, 6, 7),
                                         0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
  }
  transpose(out);
}

/// Loads four consecutive numbers from each of four rows, transposed: out[i][l] = row[l][first + i].
GROUSER_SIMD void gatherRows(const double* const (&row)[4], int first, Double4 (&out)[4]) {
#pragma GCC unroll 4
  for (int l = 0; l < 4; ++l) out[l] = load<Double4>(row[l] + first);
  transpose(out);
}

} // namespace grouser::base

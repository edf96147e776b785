// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <immintrin.h>

/// Numbers side by side in one register, one for each of several contacts, and the way between them and rows: a row is
/// four numbers of one contact, as records of grains have them.
namespace grouser::terrain::detail {

#define GROUSER_LANE_FUNCTION inline __attribute__((always_inline))

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Word4 = std::uint32_t __attribute__((vector_size(16)));
using Long2 = std::uint64_t __attribute__((vector_size(16)));
using Long4 = std::int64_t __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));

template <int kWidth> struct LanesOf {
  using Float __attribute__((vector_size(4 * kWidth))) = float;
  using Int __attribute__((vector_size(4 * kWidth))) = std::int32_t;
  using Long __attribute__((vector_size(8 * kWidth))) = std::int64_t;
};
template <int kWidth> using Lanes = typename LanesOf<kWidth>::Float;
template <int kWidth> using IntLanes = typename LanesOf<kWidth>::Int;
template <int kWidth> using LongLanes = typename LanesOf<kWidth>::Long;

/// The same bits, seen as another type of the same size.
template <class To, class From> GROUSER_LANE_FUNCTION To bitsOf(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

template <class Vector> GROUSER_LANE_FUNCTION Vector load(const void* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class Vector> GROUSER_LANE_FUNCTION void store(void* to, const Vector& v) { std::memcpy(to, &v, sizeof v); }

/// Where three numbers lie alone, a fourth may be another's, or beyond the end. Two loads and no detour by the stack.
GROUSER_LANE_FUNCTION Float4 load3(const void* from) {
  std::uint64_t first;
  std::uint32_t last;
  std::memcpy(&first, from, sizeof first);
  std::memcpy(&last, static_cast<const char*>(from) + sizeof first, sizeof last);
  return bitsOf<Float4>(Long2{first, last});
}
GROUSER_LANE_FUNCTION void store3(void* to, const Float4& v) {
  const std::uint64_t first = bitsOf<Long2>(v)[0];
  const float last = v[2];
  std::memcpy(to, &first, sizeof first);
  std::memcpy(static_cast<char*>(to) + sizeof first, &last, sizeof last);
}

/// Correctly rounded in every lane (IEEE 754).
template <class Vector> GROUSER_LANE_FUNCTION Vector squareRoot(const Vector& x) {
  Vector r;
  for (std::size_t l = 0; l < sizeof x / sizeof x[0]; ++l) r[l] = std::sqrt(x[l]);
  return r;
}

// Conversions of four: the compiler's own go by pairs.
#if defined(__AVX2__)
GROUSER_LANE_FUNCTION Double4 toDouble(const Float4& v) { return bitsOf<Double4>(_mm256_cvtps_pd(bitsOf<__m128>(v))); }
GROUSER_LANE_FUNCTION Double4 toDouble(const Int4& v) {
  return bitsOf<Double4>(_mm256_cvtepi32_pd(bitsOf<__m128i>(v)));
}
GROUSER_LANE_FUNCTION Float4 toFloat(const Double4& v) { return bitsOf<Float4>(_mm256_cvtpd_ps(bitsOf<__m256d>(v))); }
/// Towards zero.
GROUSER_LANE_FUNCTION Int4 toInt(const Double4& v) { return bitsOf<Int4>(_mm256_cvttpd_epi32(bitsOf<__m256d>(v))); }
GROUSER_LANE_FUNCTION Double4 roundedDown(const Double4& v) {
  return bitsOf<Double4>(_mm256_floor_pd(bitsOf<__m256d>(v)));
}
#else
GROUSER_LANE_FUNCTION Double4 toDouble(const Float4& v) { return __builtin_convertvector(v, Double4); }
GROUSER_LANE_FUNCTION Double4 toDouble(const Int4& v) { return __builtin_convertvector(v, Double4); }
GROUSER_LANE_FUNCTION Float4 toFloat(const Double4& v) { return __builtin_convertvector(v, Float4); }
GROUSER_LANE_FUNCTION Int4 toInt(const Double4& v) { return __builtin_convertvector(v, Int4); }
GROUSER_LANE_FUNCTION Double4 roundedDown(const Double4& v) {
  Double4 r;
  for (int l = 0; l < 4; ++l) r[l] = std::floor(v[l]);
  return r;
}
#endif

GROUSER_LANE_FUNCTION Int4 clamped(const Int4& v, int least, int most) {
  const Int4 low = Int4{} + least, high = Int4{} + most, below = v < high ? v : high;
  return below > low ? below : low;
}

/// One bit for each lane of a comparison's result, lane 0 lowest.
GROUSER_LANE_FUNCTION unsigned bitsSet(const IntLanes<4>& truth) {
  return static_cast<unsigned>(_mm_movemask_ps(bitsOf<__m128>(truth)));
}
GROUSER_LANE_FUNCTION unsigned bitsSet(const Long4& truth) {
#if defined(__AVX__)
  return static_cast<unsigned>(_mm256_movemask_pd(bitsOf<__m256d>(truth)));
#else
  return (truth[0] & 1) | (truth[1] & 2) | (truth[2] & 4) | (truth[3] & 8);
#endif
}
#if defined(__AVX2__)
GROUSER_LANE_FUNCTION unsigned bitsSet(const IntLanes<8>& truth) {
  return static_cast<unsigned>(_mm256_movemask_ps(bitsOf<__m256>(truth)));
}
#endif
#if defined(__AVX512F__)
GROUSER_LANE_FUNCTION unsigned bitsSet(const IntLanes<16>& truth) {
  return _mm512_movepi32_mask(bitsOf<__m512i>(truth));
}
#endif

/// The numbers whose bits are set, in their order, from `to` on; what follows there, up to the width, is lost.
template <int kWidth> GROUSER_LANE_FUNCTION void storeMarked(void* to, const IntLanes<kWidth>& v, unsigned marks) {
#if defined(__AVX512VL__)
  if constexpr (kWidth == 16)
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(marks), bitsOf<__m512i>(v)));
  else
    _mm256_storeu_si256(static_cast<__m256i*>(to),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(marks), bitsOf<__m256i>(v)));
#else
  for (int l = 0; l < kWidth; ++l) {
    const std::int32_t number = v[l];
    std::memcpy(to, &number, sizeof number);
    to = static_cast<char*>(to) + sizeof number * (marks >> l & 1);
  }
#endif
}

/// Columns of 4 x 4 blocks of numbers become rows, in each 16 bytes of the registers; its own inverse.
template <class Vector> GROUSER_LANE_FUNCTION void transpose(Vector (&r)[4]) {
  constexpr int kWidth = sizeof(Vector) / 4;
  IntLanes<kWidth> low, high, first, second;
  for (int l = 0; l < kWidth; ++l) {
    const int block = l / 4 * 4, place = l % 4;
    low[l] = block + place / 2 + place % 2 * kWidth;   // 0 W 1 W+1
    high[l] = low[l] + 2;                              // 2 W+2 3 W+3
    first[l] = block + place % 2 + place / 2 * kWidth; // 0 1 W W+1
    second[l] = first[l] + 2;                          // 2 3 W+2 W+3
  }
  const Vector a = __builtin_shuffle(r[0], r[1], low), b = __builtin_shuffle(r[2], r[3], low);
  const Vector c = __builtin_shuffle(r[0], r[1], high), d = __builtin_shuffle(r[2], r[3], high);
  r[0] = __builtin_shuffle(a, b, first), r[1] = __builtin_shuffle(a, b, second);
  r[2] = __builtin_shuffle(c, d, first), r[3] = __builtin_shuffle(c, d, second);
}

/// Records of 16 bytes at `from`, those that `which` names, by component; which[l] in lane l.
template <int kWidth>
GROUSER_LANE_FUNCTION void gatherRows(const void* from, const std::uint32_t* which, IntLanes<kWidth> (&out)[4]) {
  const auto row = [&](int l) { return load<Int4>(static_cast<const char*>(from) + 16 * std::size_t{which[l]}); };
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

/// Four numbers of each of kWidth contacts, by number; the contacts stand in an order of their own, that of
/// `storeRows`.
template <int kWidth> GROUSER_LANE_FUNCTION void loadRows(const Float4* rows, Lanes<kWidth> (&out)[4]) {
  constexpr int kStride = kWidth / 4; // rows that one register holds
  out[0] = load<Lanes<kWidth>>(rows), out[1] = load<Lanes<kWidth>>(rows + kStride);
  out[2] = load<Lanes<kWidth>>(rows + 2 * kStride), out[3] = load<Lanes<kWidth>>(rows + 3 * kStride);
  transpose(out);
}
template <int kWidth> GROUSER_LANE_FUNCTION void storeRows(Float4* rows, Lanes<kWidth> (&in)[4]) {
  transpose(in);
  constexpr int kStride = kWidth / 4;
  store(rows, in[0]), store(rows + kStride, in[1]);
  store(rows + 2 * kStride, in[2]), store(rows + 3 * kStride, in[3]);
}

} // namespace grouser::terrain::detail

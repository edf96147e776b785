// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/bits.hpp"
#include "base/number.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

/// SIMD vectors: the compiler's vector types, with lane-wise operators, comparisons and `mask ? a : b`. A vector wider
/// than the registers is split; the operations per lane and their order are unchanged, so the results are bitwise
/// equal. Fused multiply-add must stay off (-ffp-contract=off).
///
/// Two ways to use the processor's instructions:
///   - fixed width (multibody: four doubles): GROUSER_SIMD_CLONES compiles a function for each
///     processor kind; the loader selects one;
///   - native width (grains: 4, 8 or 16 floats): one source file for each width, compiled with the options for this
///     width, and selected at run time. Such a file must not emit functions that other files also emit, because the
///     linker might use its copy for the whole program. Therefore all callees are inlined (GROUSER_SIMD here, `flatten`
///     on the only function of the file), and the test simd.alone inspects the object files of optimised builds.
///
/// Highway and std::experimental::simd are unsuitable: their vectors cannot replace float everywhere (struct members,
/// arrays, operators of base::Vec3 with scalars), so each law would need a second version.
namespace grouser::base {

#define GROUSER_SIMD inline __attribute__((always_inline))
// Tests may override this macro. It is empty under the address sanitizer, which is initialised after the selection of
// clones, and for clang (used by the linter), which rejects flattened clones.
#if !defined(GROUSER_SIMD_CLONES)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define GROUSER_SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default"), flatten))
#else
#define GROUSER_SIMD_CLONES
#endif
#endif

template <class T, int kWidth> struct SimdOf { using Type __attribute__((vector_size(sizeof(T) * kWidth))) = T; };
/// Vector of kWidth numbers of type T.
template <class T, int kWidth> using Simd = typename SimdOf<T, kWidth>::Type;

template <class T>
concept SimdVector = !std::is_class_v<T> && !std::is_pointer_v<T> && !std::is_array_v<T> && requires(T v) {
  v[0];
};

template <SimdVector V> inline constexpr int kWidthOf = sizeof(V) / sizeof(V{}[0]);

/// Converts lane by lane, like static_cast.
template <class To, SimdVector From> GROUSER_SIMD Simd<To, kWidthOf<From>> convert(const From& v) {
  return __builtin_convertvector(v, Simd<To, kWidthOf<From>>);
}

template <SimdVector V> GROUSER_SIMD V load(const void* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <SimdVector V> GROUSER_SIMD void store(void* to, const V& v) { std::memcpy(to, &v, sizeof v); }

template <SimdVector V> GROUSER_SIMD V absolute(const V& x) { return x < V{} ? -x : x; }

/// Returns a mask as bits, lane 0 lowest.
template <SimdVector Mask> GROUSER_SIMD unsigned laneBits(const Mask& mask) {
  constexpr int kLane = sizeof(mask[0]), kBytes = sizeof mask;
  static_assert(kLane == 4 || kLane == 8);
#if defined(__AVX512DQ__)
  if constexpr (kBytes == 64 && kLane == 4) return _mm512_movepi32_mask(bitsAs<__m512i>(mask));
#endif
#if defined(__AVX__)
  if constexpr (kBytes == 32 && kLane == 4)
    return static_cast<unsigned>(_mm256_movemask_ps(bitsAs<__m256>(mask)));
  else if constexpr (kBytes == 32)
    return static_cast<unsigned>(_mm256_movemask_pd(bitsAs<__m256d>(mask)));
#endif
#if defined(__x86_64__)
  if constexpr (kBytes == 16 && kLane == 4) return static_cast<unsigned>(_mm_movemask_ps(bitsAs<__m128>(mask)));
#endif
  unsigned bits = 0;
  for (int l = 0; l < kWidthOf<Mask>; ++l) bits |= static_cast<unsigned>(mask[l] & 1) << l;
  return bits;
}

template <SimdVector V> struct NumberTraits<V> {
  using Scalar = std::remove_cvref_t<decltype(V{}[0])>;
  GROUSER_SIMD static V broadcast(Scalar x) { return x - V{}; }
  GROUSER_SIMD static V squareRoot(const V& x) {
    V r = x; // initialised: at -O1 the compiler does not detect that all lanes are set
#pragma GCC unroll 16
    for (int l = 0; l < kWidthOf<V>; ++l) r[l] = std::sqrt(x[l]);
    return r;
  }
  GROUSER_SIMD static V cubeRoot(const V& x) { return cubeRootBy<Simd<std::uint32_t, kWidthOf<V>>>(x); } // floats only
  GROUSER_SIMD static bool any(const V& mask) {
    // GROUSER_SIMD_CLONES compile this without __AVX__; the compiler then finds the matching instruction.
    if constexpr (sizeof mask == 32 && sizeof(Scalar) == 8) return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0;
    return laneBits(mask) != 0;
  }
};

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <cstring>

/// Four numbers side by side: four bodies or joints that are treated alike, one in each lane. The compiler makes one
/// register of them where the processor has it (AVX) and two where not; the operations on each number and their order
/// are the same, hence the same bits. The formulas themselves are those of base/vec.hpp, with Lanes in place of double.
namespace grouser::multibody::detail {

inline constexpr int kLanes = 4;
using Lanes = double __attribute__((vector_size(8 * kLanes)));
using Vec3L = base::Vec3<Lanes>;
using Mat3L = base::Mat3<Lanes>;

/// Functions that work on lanes: compiled for AVX-512 (more registers), AVX2 and plain x86-64, chosen at load time.
/// None of them may fuse multiply and add (-ffp-contract=off). Tests choose for themselves.
#if !defined(GROUSER_LANES)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__)
#define GROUSER_LANES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default"), flatten))
#else
#define GROUSER_LANES
#endif
#endif
#define GROUSER_KERNEL inline __attribute__((always_inline))

GROUSER_KERNEL Lanes all(double x) { return Lanes{x, x, x, x}; }
GROUSER_KERNEL Vec3L all(const base::Vec3<double>& v) { return {all(v.x), all(v.y), all(v.z)}; }

GROUSER_KERNEL Lanes squareRoot(const Lanes& x) {
  Lanes r;
#pragma GCC unroll 4
  for (int l = 0; l < kLanes; ++l) r[l] = std::sqrt(x[l]);
  return r;
}

GROUSER_KERNEL void store4(double* to, const Lanes& x) { std::memcpy(to, &x, sizeof x); }

/// Reads four consecutive numbers of each lane's row: out[i][l] = row[l][i].
GROUSER_KERNEL void gather4(const double* const (&row)[kLanes], int first, Lanes (&out)[4]) {
  Lanes r[kLanes];
#pragma GCC unroll 4
  for (int l = 0; l < kLanes; ++l) std::memcpy(&r[l], row[l] + first, sizeof r[l]);
  // Transposed by pairs, then by halves.
  const Lanes a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Lanes c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  out[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), out[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  out[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5), out[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/// The inverse: columns in, one row of four numbers for each lane out.
GROUSER_KERNEL void transpose4(const Lanes (&in)[4], Lanes (&row)[kLanes]) {
  const Lanes a = __builtin_shufflevector(in[0], in[1], 0, 4, 2, 6);
  const Lanes b = __builtin_shufflevector(in[0], in[1], 1, 5, 3, 7);
  const Lanes c = __builtin_shufflevector(in[2], in[3], 0, 4, 2, 6);
  const Lanes d = __builtin_shufflevector(in[2], in[3], 1, 5, 3, 7);
  row[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), row[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  row[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5), row[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

} // namespace grouser::multibody::detail

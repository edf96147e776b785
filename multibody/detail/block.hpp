// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd.hpp"

#include <array>
#include <cmath>

/// Kernels on 6x6 blocks, and on vectors of 6 numbers padded to 8. A block is stored by columns of 8 numbers, padded
/// likewise (entry (row, column) at [8 column + row]; a column is one cache line). A column is one compiler vector: one
/// register with AVX-512, two with AVX2, four with SSE2. The order of operations on each number is always the same, so
/// the results are bitwise equal. The last two lanes are always zero.
namespace grouser::multibody::detail {

inline constexpr int kStride = 8;
struct alignas(64) Block : std::array<double, 6 * kStride> {};
struct alignas(64) Vector6 : std::array<double, kStride> {};

using Column8 = base::Simd<double, 8>;
using Column4 = base::Simd<double, 4>;
using Column2 = base::Simd<double, 2>;

/// A = L d L^T in place: unit lower L below the diagonal of `A`, 1/d in `dInverse`. Skips rows that are not in the bit
/// mask `active`, and rows with a pivot not larger in magnitude than their entry of `smallest`; for these, 1/d = 0.
/// Returns the mask of the rows kept.
GROUSER_SIMD unsigned factor6(double* __restrict A, double* __restrict dInverse, const double* __restrict smallest,
                              unsigned active) {
  unsigned kept = 0;
  Column8 a[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) a[j] = base::load<Column8>(A + kStride * j);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    const double d = a[j][j];
    const bool keep = (active >> j & 1u) && std::fabs(d) > smallest[j];
    kept |= static_cast<unsigned>(keep) << j;
    const double inverse = keep ? 1 / d : 0.0;
    dInverse[j] = inverse;
    const Column8 l = a[j] * inverse;
#pragma GCC unroll 6
    for (int k = j + 1; k < 6; ++k) a[k] -= l * a[j][k];
    base::store(A + kStride * j, l);
  }
  return kept;
}

/// W <- W L^-T, and V = W diag(1/d).
GROUSER_SIMD void solveRight6(double* __restrict W, double* __restrict V, const double* __restrict L,
                              const double* __restrict dInverse) {
  Column8 w[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    w[j] = base::load<Column8>(W + kStride * j);
#pragma GCC unroll 6
    for (int k = 0; k < j; ++k) w[j] -= w[k] * L[kStride * k + j];
    base::store(W + kStride * j, w[j]);
    base::store(V + kStride * j, w[j] * dInverse[j]);
  }
}

/// K -= V W^T.
GROUSER_SIMD void subtractProduct6(double* __restrict K, const double* __restrict V, const double* __restrict W) {
  Column8 v[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) v[j] = base::load<Column8>(V + kStride * j);
#pragma GCC unroll 6
  for (int c = 0; c < 6; ++c) {
    Column8 k = base::load<Column8>(K + kStride * c);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) k -= v[j] * W[kStride * j + c];
    base::store(K + kStride * c, k);
  }
}

/// y -= V x.
GROUSER_SIMD void subtractTimes6(double* __restrict y, const double* __restrict V, const double* __restrict x) {
  Column8 sum = base::load<Column8>(y);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    const auto v = base::load<Column8>(V + kStride * j);
    sum -= v * x[j];
  }
  base::store(y, sum);
}

/// y -= V^T x.
GROUSER_SIMD void subtractTransposedTimes6(double* __restrict y, const double* __restrict V,
                                           const double* __restrict x) {
  const auto s = base::load<Column8>(x);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    const auto v = base::load<Column8>(V + kStride * j);
    const Column8 p = v * s;
    // Pairwise sums of register halves: ((0 + 4) + 2) + ((1 + 5) + 3).
    const Column4 h = Column4{p[0], p[1], p[2], p[3]} + Column4{p[4], p[5], 0, 0};
    const Column2 q = Column2{h[0], h[1]} + Column2{h[2], h[3]};
    y[j] -= q[0] + q[1];
  }
}

/// y <- L^-1 y.
GROUSER_SIMD void forward6(double* __restrict y, const double* __restrict L) {
#pragma GCC unroll 6
  for (int j = 0; j < 5; ++j)
#pragma GCC unroll 6
    for (int i = j + 1; i < 6; ++i) y[i] -= L[kStride * j + i] * y[j];
}

/// x <- L^-T x.
GROUSER_SIMD void backward6(double* __restrict x, const double* __restrict L) {
#pragma GCC unroll 6
  for (int j = 4; j >= 0; --j)
#pragma GCC unroll 6
    for (int i = 5; i > j; --i) x[j] -= L[kStride * j + i] * x[i];
}

} // namespace grouser::multibody::detail

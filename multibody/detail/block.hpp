// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

/// Kernels on 6x6 blocks, column-major (entry (row, column) at [6 column + row]), and on vectors of 6. Written as plain
/// loops of fixed length in a fixed order of operations: the compiler may use wider vectors, the bits stay the same.
namespace grouser::multibody::detail {

#define GROUSER_KERNEL inline __attribute__((always_inline))

/// A = L d L^T in place: unit lower L below the diagonal of `A`, 1/d in `dInverse`. A row that is not in the bit mask
/// `active`, or whose pivot does not exceed its entry of `smallest` in size, is left out: its 1/d is 0. Returns the
/// mask of the rows kept.
GROUSER_KERNEL unsigned factor6(double* __restrict A, double* __restrict dInverse, const double* __restrict smallest,
                                unsigned active) {
  unsigned kept = 0;
  for (int j = 0; j < 6; ++j) {
    const double d = A[6 * j + j];
    if (!(active >> j & 1u) || !(std::fabs(d) > smallest[j])) {
      dInverse[j] = 0;
      for (int i = j + 1; i < 6; ++i) A[6 * j + i] = 0;
      continue;
    }
    kept |= 1u << j;
    const double inverse = 1 / d;
    dInverse[j] = inverse;
    double l[6];
    for (int i = j + 1; i < 6; ++i) l[i] = A[6 * j + i] * inverse;
    for (int k = j + 1; k < 6; ++k) {
      const double a = A[6 * j + k];
      for (int i = k; i < 6; ++i) A[6 * k + i] -= l[i] * a;
    }
    for (int i = j + 1; i < 6; ++i) A[6 * j + i] = l[i];
  }
  return kept;
}

/// W <- W L^-T, and V = W diag(1/d).
GROUSER_KERNEL void solveRight6(double* __restrict W, double* __restrict V, const double* __restrict L,
                                const double* __restrict dInverse) {
  for (int j = 0; j < 6; ++j) {
    double w[6];
    for (int i = 0; i < 6; ++i) w[i] = W[6 * j + i];
    for (int k = 0; k < j; ++k) {
      const double l = L[6 * k + j];
      for (int i = 0; i < 6; ++i) w[i] -= W[6 * k + i] * l;
    }
    for (int i = 0; i < 6; ++i) W[6 * j + i] = w[i];
    for (int i = 0; i < 6; ++i) V[6 * j + i] = w[i] * dInverse[j];
  }
}

/// The same for a body alone, whose block is diag(m, m, m, I_W): only the last three columns mix.
GROUSER_KERNEL void solveRightBody6(double* __restrict W, double* __restrict V, const double* __restrict L,
                                    const double* __restrict dInverse) {
  const double l43 = L[22], l53 = L[23], l54 = L[29];
  for (int i = 0; i < 6; ++i) {
    W[24 + i] -= W[18 + i] * l43;
    W[30 + i] = (W[30 + i] - W[18 + i] * l53) - W[24 + i] * l54;
  }
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) V[6 * j + i] = W[6 * j + i] * dInverse[j];
}

/// K -= V W^T.
GROUSER_KERNEL void subtractProduct6(double* __restrict K, const double* __restrict V, const double* __restrict W) {
  for (int c = 0; c < 6; ++c) {
    double k[6];
    for (int i = 0; i < 6; ++i) k[i] = K[6 * c + i];
    for (int j = 0; j < 6; ++j) {
      const double w = W[6 * j + c];
      for (int i = 0; i < 6; ++i) k[i] -= V[6 * j + i] * w;
    }
    for (int i = 0; i < 6; ++i) K[6 * c + i] = k[i];
  }
}

/// Lower triangle (in pairs of rows) of K -= V W^T, where the product is symmetric.
GROUSER_KERNEL void subtractSymmetric6(double* __restrict K, const double* __restrict V, const double* __restrict W) {
  for (int c = 0; c < 6; c += 2) {
    double k[6], m[6];
    for (int i = c; i < 6; ++i) k[i] = K[6 * c + i], m[i] = K[6 * c + 6 + i];
    for (int j = 0; j < 6; ++j) {
      const double w = W[6 * j + c], u = W[6 * j + c + 1];
      for (int i = c; i < 6; ++i) k[i] -= V[6 * j + i] * w;
      for (int i = c; i < 6; ++i) m[i] -= V[6 * j + i] * u;
    }
    for (int i = c; i < 6; ++i) K[6 * c + i] = k[i], K[6 * c + 6 + i] = m[i];
  }
}

/// y -= V x.
GROUSER_KERNEL void subtractTimes6(double* __restrict y, const double* __restrict V, const double* __restrict x) {
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) y[i] -= V[6 * j + i] * x[j];
}

/// y -= V^T x.
GROUSER_KERNEL void subtractTransposedTimes6(double* __restrict y, const double* __restrict V,
                                             const double* __restrict x) {
  for (int j = 0; j < 6; ++j) {
    const double* v = V + 6 * j;
    // Two lanes and one sum: the order a pair of vector registers gives.
    const double even = v[0] * x[0] + v[2] * x[2] + v[4] * x[4];
    const double odd = v[1] * x[1] + v[3] * x[3] + v[5] * x[5];
    y[j] -= even + odd;
  }
}

/// y <- L^-1 y.
GROUSER_KERNEL void forward6(double* __restrict y, const double* __restrict L) {
  for (int j = 0; j < 5; ++j)
    for (int i = j + 1; i < 6; ++i) y[i] -= L[6 * j + i] * y[j];
}

/// x <- L^-T x.
GROUSER_KERNEL void backward6(double* __restrict x, const double* __restrict L) {
  for (int j = 4; j >= 0; --j)
    for (int i = 5; i > j; --i) x[j] -= L[6 * j + i] * x[i];
}

} // namespace grouser::multibody::detail

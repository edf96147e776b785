// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstring>

/// Kernels on 6x6 blocks, column-major (entry (row, column) at [6 column + row]), and on vectors of 6. A column is
/// handled as a vector of 4 and one of 2 (compiler vector types: whatever registers the target has, the same operations
/// in the same order on each number, hence the same bits).
namespace grouser::multibody::detail {

#define GROUSER_KERNEL inline __attribute__((always_inline))

using Lanes4 = double __attribute__((vector_size(32)));
using Lanes2 = double __attribute__((vector_size(16)));

/// Six numbers of a column. Passed by reference only, so that no calling convention depends on the target.
struct Column {
  Lanes4 a; ///< rows 0..3
  Lanes2 b; ///< rows 4, 5
};

GROUSER_KERNEL void load(Column& c, const double* p) {
  std::memcpy(&c.a, p, sizeof c.a);
  std::memcpy(&c.b, p + 4, sizeof c.b);
}
GROUSER_KERNEL void store(double* p, const Column& c) {
  std::memcpy(p, &c.a, sizeof c.a);
  std::memcpy(p + 4, &c.b, sizeof c.b);
}
/// y -= x s
GROUSER_KERNEL void subtract(Column& y, const Column& x, double s) {
  y.a -= x.a * s;
  y.b -= x.b * s;
}

GROUSER_KERNEL double entry(const Column& c, int row) { return row < 4 ? c.a[row] : c.b[row - 4]; }
GROUSER_KERNEL void clear6(double* p) {
  const Column zero{};
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) store(p + 6 * j, zero);
}

/// A = L d L^T in place: unit lower L below the diagonal of `A`, 1/d in `dInverse`. A row that is not in the bit mask
/// `active`, or whose pivot does not exceed its entry of `smallest` in size, is left out: its 1/d is 0. Returns the
/// mask of the rows kept.
GROUSER_KERNEL unsigned factor6(double* __restrict A, double* __restrict dInverse, const double* __restrict smallest,
                                unsigned active) {
  unsigned kept = 0;
  Column a[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) load(a[j], A + 6 * j);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    const double d = entry(a[j], j);
    const bool keep = (active >> j & 1u) && std::fabs(d) > smallest[j];
    kept |= static_cast<unsigned>(keep) << j;
    const double inverse = keep ? 1 / d : 0.0;
    dInverse[j] = inverse;
    const Column l{a[j].a * inverse, a[j].b * inverse};
#pragma GCC unroll 6
    for (int k = j + 1; k < 6; ++k) subtract(a[k], l, entry(a[j], k));
    store(A + 6 * j, l);
  }
  return kept;
}

/// W <- W L^-T, and V = W diag(1/d).
GROUSER_KERNEL void solveRight6(double* __restrict W, double* __restrict V, const double* __restrict L,
                                const double* __restrict dInverse) {
  Column w[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    load(w[j], W + 6 * j);
#pragma GCC unroll 6
    for (int k = 0; k < j; ++k) subtract(w[j], w[k], L[6 * k + j]);
    store(W + 6 * j, w[j]);
    const Column v{w[j].a * dInverse[j], w[j].b * dInverse[j]};
    store(V + 6 * j, v);
  }
}

/// V = W M^-1 for a body alone; `inverse` holds 1/m and the inverse inertia on its diagonal blocks.
GROUSER_KERNEL void timesBodyInverse6(double* __restrict V, const double* __restrict W,
                                      const double* __restrict inverse) {
  Column w[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) load(w[j], W + 6 * j);
#pragma GCC unroll 6
  for (int j = 0; j < 3; ++j) {
    const Column v{w[j].a * inverse[0], w[j].b * inverse[0]};
    store(V + 6 * j, v);
  }
#pragma GCC unroll 6
  for (int j = 3; j < 6; ++j) {
    const double x = inverse[6 * j + 3], y = inverse[6 * j + 4], z = inverse[6 * j + 5];
    const Column v{w[3].a * x + w[4].a * y + w[5].a * z, w[3].b * x + w[4].b * y + w[5].b * z};
    store(V + 6 * j, v);
  }
}

/// K -= V W^T.
GROUSER_KERNEL void subtractProduct6(double* __restrict K, const double* __restrict V, const double* __restrict W) {
  Column v[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) load(v[j], V + 6 * j);
#pragma GCC unroll 6
  for (int c = 0; c < 6; ++c) {
    Column k;
    load(k, K + 6 * c);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) subtract(k, v[j], W[6 * j + c]);
    store(K + 6 * c, k);
  }
}

/// Lower triangle (and the entries above it that come along) of K -= V W^T, where the product is symmetric. Keeps to
/// the split of 4 and 2 rows throughout: a load that straddles two fresh stores would wait for both.
GROUSER_KERNEL void subtractSymmetric6(double* __restrict K, const double* __restrict V, const double* __restrict W) {
  Column v[6];
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) load(v[j], V + 6 * j);
#pragma GCC unroll 6
  for (int c = 0; c < 4; ++c) {
    Column k;
    load(k, K + 6 * c);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) subtract(k, v[j], W[6 * j + c]);
    store(K + 6 * c, k);
  }
#pragma GCC unroll 6
  for (int c = 4; c < 6; ++c) { // rows 4, 5
    Lanes2 k;
    std::memcpy(&k, K + 6 * c + 4, sizeof k);
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) k -= v[j].b * W[6 * j + c];
    std::memcpy(K + 6 * c + 4, &k, sizeof k);
  }
}

/// y -= V x.
GROUSER_KERNEL void subtractTimes6(double* __restrict y, const double* __restrict V, const double* __restrict x) {
  Column sum, v;
  load(sum, y);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    load(v, V + 6 * j);
    subtract(sum, v, x[j]);
  }
  store(y, sum);
}

/// y -= V^T x.
GROUSER_KERNEL void subtractTransposedTimes6(double* __restrict y, const double* __restrict V,
                                             const double* __restrict x) {
  Column s, v;
  load(s, x);
#pragma GCC unroll 6
  for (int j = 0; j < 6; ++j) {
    load(v, V + 6 * j);
    const Lanes4 p = v.a * s.a;
    const Lanes2 q = v.b * s.b;
    // Pairs first, as the halves of a register: ((0 + 4) + 2) + ((1 + 5) + 3).
    const Lanes2 low = {p[0], p[1]}, high = {p[2], p[3]};
    const Lanes2 t = low + q + high;
    y[j] -= t[0] + t[1];
  }
}

/// y <- M^-1 y for a body alone.
GROUSER_KERNEL void applyBodyInverse6(double* __restrict y, const double* __restrict inverse) {
#pragma GCC unroll 6
  for (int i = 0; i < 3; ++i) y[i] *= inverse[0];
  const double a = y[3], b = y[4], c = y[5];
#pragma GCC unroll 6
  for (int i = 3; i < 6; ++i) y[i] = inverse[18 + i] * a + inverse[24 + i] * b + inverse[30 + i] * c;
}

/// y <- L^-1 y.
GROUSER_KERNEL void forward6(double* __restrict y, const double* __restrict L) {
#pragma GCC unroll 6
  for (int j = 0; j < 5; ++j)
#pragma GCC unroll 6
    for (int i = j + 1; i < 6; ++i) y[i] -= L[6 * j + i] * y[j];
}

/// x <- L^-T x.
GROUSER_KERNEL void backward6(double* __restrict x, const double* __restrict L) {
#pragma GCC unroll 6
  for (int j = 4; j >= 0; --j)
#pragma GCC unroll 6
    for (int i = 5; i > j; --i) x[j] -= L[6 * j + i] * x[i];
}

} // namespace grouser::multibody::detail

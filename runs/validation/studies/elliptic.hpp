// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::studies {

/// Jacobi's elliptic functions of the argument u and the modulus k, 0 <= k < 1.
struct Jacobi {
  double sn, cn, dn;
};
/// sn, cn and dn by the arithmetic-geometric mean (Abramowitz and Stegun 1964, 16.4); absolute error about
/// 1e-15 (1 + |u|).
Jacobi jacobi(double u, double k);
/// Complete elliptic integral of the first kind, K(k), by the same method (17.6).
double quarterPeriod(double k);

} // namespace grouser::studies

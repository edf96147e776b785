// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/elliptic.hpp"

#include "base/math.hpp"

#include <array>
#include <cmath>

namespace grouser::studies {

namespace {

/// Iterations of the arithmetic-geometric mean; each iteration doubles the number of correct digits.
constexpr int kMeans = 10;

struct Means {
  std::array<double, kMeans + 1> a, c;
};

Means means(double k) {
  Means m;
  double a = 1, b = std::sqrt((1 - k) * (1 + k));
  m.a[0] = a, m.c[0] = k;
  for (std::size_t n = 1; n <= kMeans; ++n) {
    m.c[n] = 0.5 * (a - b);
    const double next = 0.5 * (a + b);
    b = std::sqrt(a * b), a = next;
    m.a[n] = a;
  }
  return m;
}

} // namespace

Jacobi jacobi(double u, double k) {
  const Means m = means(k);
  const double period = 2 * base::kPi / m.a[kMeans]; // 4 K, the period of sn and cn
  u -= period * std::floor(u / period + 0.5);
  double phi = std::ldexp(m.a[kMeans] * u, kMeans);
  for (std::size_t n = kMeans; n > 0; --n) phi = 0.5 * (phi + std::asin(m.c[n] / m.a[n] * std::sin(phi)));
  const double sn = std::sin(phi), cn = std::cos(phi);
  // This is 1 - k^2 sn^2 without cancellation for k near 1.
  return {sn, cn, std::sqrt((1 - k) * (1 + k) + k * k * cn * cn)};
}

double quarterPeriod(double k) { return 0.5 * base::kPi / means(k).a[kMeans]; }

} // namespace grouser::studies

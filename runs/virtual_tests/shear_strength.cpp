// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/shear_strength.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::virtual_tests {

namespace {

constexpr int kTrials = 60; // maximum iterations in the search for K: they shrink the bracket to 3e-13
constexpr double kNarrowest = 1e-4, kWidest = 3; // range of K / largest displacement

double meanOf(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += values[k];
  return sum / static_cast<double>(to - from);
}

/// Sums for a line tau = c + sigma tan phi.
struct Line {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  void add(double sigma, double tau, double times) {
    n += times, x += times * sigma, y += times * tau, xx += times * sigma * sigma, xy += times * sigma * tau;
  }
  void solve(double& cohesion, double& angle) const {
    const double spread = xx - x * x / n;
    const bool isOne = !(spread > 0.01 * xx); // all normal stresses are equal except for scatter: a single load
    const double slope = isOne ? xy / xx : (xy - x * y / n) / spread;
    cohesion = isOne ? 0 : (y - slope * x) / n;
    angle = std::atan(slope) * 180 / base::kPi;
  }
};

/// A shear curve divided by its residual strength.
struct Normalised {
  const ShearCurve* curve;
  double residual, times;
};

/// Mean square residual of Janosi's equation.
double misfitOf(const std::vector<Normalised>& curves, double shearModulus) {
  double squares = 0, points = 0;
  for (const Normalised& c : curves)
    for (std::size_t i = 0; i < c.curve->displacement.size(); ++i) {
      const double form = -std::expm1(-c.curve->displacement[i] / shearModulus);
      const double left = c.curve->shear[i] / c.residual - form;
      squares += c.times * left * left, points += c.times;
    }
  return squares / points;
}

/// Golden-section search over ln K. The error has a single minimum, because the curves rise.
double bestModulus(const std::vector<Normalised>& curves) {
  double way = 0;
  for (const Normalised& c : curves) way = std::max(way, c.curve->displacement.back());
  const double ratio = 0.5 * (std::sqrt(5.0) - 1);
  double low = std::log(kNarrowest * way), high = std::log(kWidest * way);
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double fa = misfitOf(curves, std::exp(a)), fb = misfitOf(curves, std::exp(b));
  for (int k = 0; k < kTrials && high - low > 1e-6; ++k) {
    if (fa < fb) {
      high = b, b = a, fb = fa;
      a = high - ratio * (high - low), fa = misfitOf(curves, std::exp(a));
    } else {
      low = a, a = b, fa = fb;
      b = low + ratio * (high - low), fb = misfitOf(curves, std::exp(b));
    }
  }
  return std::exp(0.5 * (low + high));
}

} // namespace

CurveStrength strengthOf(const ShearCurve& curve) {
  CurveStrength s;
  const std::size_t n = curve.displacement.size(), half = n / 2, window = std::max<std::size_t>(1, n / 20);
  s.residualShear = meanOf(curve.shear, half, n), s.residualNormal = meanOf(curve.normal, half, n);
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k + window <= n; ++k) {
    const double shear = meanOf(curve.shear, k, k + window), normal = meanOf(curve.normal, k, k + window);
    if (shear / normal > best) best = shear / normal, s.peakShear = shear, s.peakNormal = normal;
  }
  return s;
}

ShearFit fitShear(const std::vector<std::vector<ShearCurve>>& tests, const std::vector<int>& counts) {
  ShearFit fit{base::kNaN, base::kNaN, base::kNaN, base::kNaN, base::kNaN, base::kNaN, base::kNaN};
  Line residual, peak;
  std::vector<Normalised> curves;
  double humps = 0, all = 0;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const double times = counts.empty() ? 1 : counts[t];
    if (times == 0) continue;
    for (const ShearCurve& curve : tests[t]) {
      const CurveStrength s = strengthOf(curve);
      // The scatter of the strength is proportional to the load.
      residual.add(s.residualNormal, s.residualShear, times / (s.residualNormal * s.residualNormal));
      peak.add(s.peakNormal, s.peakShear, times / (s.peakNormal * s.peakNormal));
      curves.push_back({&curve, s.residualShear, times});
      humps += times * s.hump(), all += times;
    }
  }
  if (curves.empty()) return fit;
  residual.solve(fit.cohesion, fit.angle), peak.solve(fit.peakCohesion, fit.peakAngle);
  fit.hump = humps / all;
  fit.shearModulus = bestModulus(curves);
  fit.misfit = std::sqrt(misfitOf(curves, fit.shearModulus));
  return fit;
}

} // namespace grouser::virtual_tests

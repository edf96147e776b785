// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/radius_distribution.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::terrain {

namespace {

double power(double x, int n) { return n == 0 ? 1.0 : x * power(x, n - 1); }

/// Integral of f from a to b by Simpson's rule.
template <class F> double integral(double a, double b, const F& f) {
  constexpr int kIntervals = 200;
  const double h = (b - a) / kIntervals;
  double sum = f(a) + f(b);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(a + i * h);
  return sum * h / 3;
}

/// Grains between two sieves, with mass uniform in the logarithm of size.
struct SieveFraction {
  double fine, coarse; ///< [m]
  double mass;         ///< share [-]

  double logRatio() const { return base::log(coarse / fine); }
  /// Mean of d^n, weighted by mass.
  double massMean(int n) const {
    if (n == 0) return 1;
    return n > 0 ? (power(coarse, n) - power(fine, n)) / (n * logRatio())
                 : (1 / power(fine, -n) - 1 / power(coarse, -n)) / (-n * logRatio());
  }
  double number() const { return mass * massMean(-3); } ///< in units of total mass / mass of a sphere of 1 m
};

/// Sieve fractions with mass.
std::vector<SieveFraction> fractionsOf(const RadiusDistribution& r) {
  std::vector<SieveFraction> all;
  for (std::size_t k = 1; k < r.sieveDiameter.size(); ++k)
    if (const double mass = r.passing[k] - r.passing[k - 1]; mass > 0)
      all.push_back({r.sieveDiameter[k - 1], r.sieveDiameter[k], mass});
  return all;
}

} // namespace

double RadiusDistribution::normalOf(double x, double square) { return x * std::sqrt(-2 * base::log(square) / square); }

double RadiusDistribution::fromNormal(double z) const { return radius * base::exp(spread * z); }

double RadiusDistribution::ofSieves(double which, double within) const {
  const std::vector<SieveFraction> fractions = fractionsOf(*this);
  double all = 0, before = 0;
  for (const SieveFraction& f : fractions) all += f.number();
  const SieveFraction* chosen = nullptr;
  for (const SieveFraction& f : fractions) {
    chosen = &f;
    before += f.number();
    if (which * all < before) break;
  }
  // Mass uniform in ln d makes the number of grains finer than d proportional to fine^-3 - d^-3.
  const double fine = 1 / power(chosen->fine, 3), coarse = 1 / power(chosen->coarse, 3);
  return 0.5 * base::pow(fine - within * (fine - coarse), -1.0 / 3);
}

double RadiusDistribution::smallest() const {
  switch (law) {
  case RadiusLaw::uniform:
    return radius * (1 - spread);
  case RadiusLaw::lognormal:
    return fromNormal(-kMaxDeviations);
  case RadiusLaw::sieve:
    return 0.5 * fractionsOf(*this).front().fine;
  default:
    return radius;
  }
}

double RadiusDistribution::largest() const {
  switch (law) {
  case RadiusLaw::uniform:
    return radius * (1 + spread);
  case RadiusLaw::lognormal:
    return fromNormal(kMaxDeviations);
  case RadiusLaw::sieve:
    return 0.5 * fractionsOf(*this).back().coarse;
  default:
    return radius;
  }
}

double RadiusDistribution::meanPower(int n) const {
  switch (law) {
  case RadiusLaw::uniform:
    return power(radius, n) * (power(1 + spread, n + 1) - power(1 - spread, n + 1)) / (2 * spread * (n + 1));
  case RadiusLaw::lognormal: {
    const auto weight = [](double z) { return base::exp(-0.5 * z * z); };
    return integral(-kMaxDeviations, kMaxDeviations, [&](double z) { return weight(z) * power(fromNormal(z), n); }) /
           integral(-kMaxDeviations, kMaxDeviations, weight);
  }
  case RadiusLaw::sieve: {
    double sum = 0, number = 0;
    for (const SieveFraction& f : fractionsOf(*this)) sum += f.mass * f.massMean(n - 3), number += f.number();
    return power(0.5, n) * sum / number;
  }
  default:
    return power(radius, n);
  }
}

double RadiusDistribution::medianByMass() const {
  if (law == RadiusLaw::sieve) {
    std::size_t k = 1;
    while (passing[k] < 0.5) ++k;
    const double share = (0.5 - passing[k - 1]) / (passing[k] - passing[k - 1]);
    return 0.5 * sieveDiameter[k - 1] * base::pow(sieveDiameter[k] / sieveDiameter[k - 1], share);
  }
  // Half of the integral of r^3 by number.
  if (law == RadiusLaw::uniform)
    return radius * std::sqrt(std::sqrt(0.5 * (power(1 + spread, 4) + power(1 - spread, 4))));
  if (law != RadiusLaw::lognormal) return radius;
  const auto mass = [&](double z) { return base::exp(-0.5 * z * z + 3 * spread * z); };
  const double all = integral(-kMaxDeviations, kMaxDeviations, mass);
  double low = -kMaxDeviations, high = kMaxDeviations;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (integral(-kMaxDeviations, middle, mass) < 0.5 * all ? low : high) = middle;
  }
  return fromNormal(0.5 * (low + high));
}

double RadiusDistribution::deviation() const {
  if (law == RadiusLaw::single) return 0;
  const double mean = meanPower(1);
  return std::sqrt(std::max(0.0, meanPower(2) / (mean * mean) - 1));
}

double RadiusDistribution::skewness() const {
  const double m = meanPower(1), deviates = deviation() * m;
  if (!(deviates > 0)) return 0;
  return (meanPower(3) - 3 * m * meanPower(2) + 2 * m * m * m) / (deviates * deviates * deviates);
}

double randomClosePacking(const RadiusDistribution& radii) {
  const double deviation = radii.deviation();
  return 0.634 + 0.0658 * deviation + 0.0857 * radii.skewness() * deviation * deviation;
}

double DepthGrading::scaleAt(double depth, double radius) const {
  if (!any() || depth <= fineDepth) return 1;
  return std::min(1 + coarsening * (depth - fineDepth) / radius, std::max(1.0, coarsestRadius / radius));
}

double DepthGrading::meanFourthPower(double depth, double radius) const {
  if (!any()) return 1;
  constexpr int kSlices = 1000;
  double grains = 0, sum = 0; // grains per slice: inversely proportional to the mean cube of their radius
  for (int i = 0; i < kSlices; ++i) {
    const double scale = scaleAt((i + 0.5) / kSlices * depth, radius);
    grains += 1 / (scale * scale * scale), sum += scale;
  }
  return sum / grains;
}

} // namespace grouser::terrain

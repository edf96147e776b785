// SPDX-License-Identifier: BSD-3-Clause
#include "runs/bevameter/pressure_sinkage.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace grouser::bevameter {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Weighted sums over the points of a test: x = ln z, y = ln p, weight p^2.
struct Sums {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
  int points = 0;

  void add(double z, double p) {
    const double weight = p * p, lz = std::log(z), lp = std::log(p);
    w += weight, x += weight * lz, y += weight * lp, xx += weight * lz * lz, xy += weight * lz * lp;
    ++points;
  }
  bool isLine() const { return points >= 2 && variance() > 0; }
  double covariance() const { return xy / w - x / w * (y / w); }
  double variance() const { return xx / w - x / w * (x / w); }
  double kOf(double n) const { return std::exp((y - n * x) / w); }
};

bool counts(const PlateTests& plate, std::size_t curve, std::size_t i, double from) {
  return plate.curves[curve].sinkage[i] > from && plate.curves[curve].pressure[i] > 0;
}

int timesOf(const std::vector<int>& counts, std::size_t curve) { return counts.empty() ? 1 : counts[curve]; }

/// The tests of a breadth. Each has a k of its own while n is sought: tests end at one pressure, so that points of firm
/// and of weak ones lie beside each other, and a line through all of them would be too flat.
struct Breadth {
  std::vector<std::pair<Sums, double>> tests; ///< and how often each counts
  double covariance = 0, variance = 0, times = 0;

  Breadth(const PlateTests& plate, double from, const std::vector<int>& counted) {
    for (std::size_t c = 0; c < plate.curves.size(); ++c) {
      Sums sums;
      for (std::size_t i = 0; timesOf(counted, c) > 0 && i < plate.curves[c].sinkage.size(); ++i)
        if (counts(plate, c, i, from)) sums.add(plate.curves[c].sinkage[i], plate.curves[c].pressure[i]);
      if (sums.isLine()) tests.emplace_back(sums, timesOf(counted, c));
    }
    for (const auto& [sums, number] : tests)
      covariance += number * sums.covariance(), variance += number * sums.variance(), times += number;
    covariance /= times, variance /= times;
  }
  bool isThere() const { return !tests.empty(); }
  double k(double n) const {
    double sum = 0;
    for (const auto& [sums, number] : tests) sum += number * sums.kOf(n);
    return sum / times;
  }
};

/// Wong's goodness of fit: 1 for all points on the curve.
double goodnessOf(const PlateTests& plate, double from, const std::vector<int>& times, double k, double n) {
  double squares = 0, sum = 0, points = 0;
  for (std::size_t c = 0; c < plate.curves.size(); ++c)
    for (std::size_t i = 0; timesOf(times, c) > 0 && i < plate.curves[c].sinkage.size(); ++i)
      if (counts(plate, c, i, from)) {
        const double p = plate.curves[c].pressure[i], difference = p - k * std::pow(plate.curves[c].sinkage[i], n);
        squares += timesOf(times, c) * difference * difference, sum += timesOf(times, c) * p;
        points += timesOf(times, c);
      }
  return points > 2 ? 1 - std::sqrt(squares / (points - 2)) / (sum / points) : kNone;
}

BekkerFit nothing() { return {kNone, kNone, kNone, {kNone, kNone}, {kNone, kNone}, {kNone, kNone}}; }

} // namespace

double BekkerFit::sinkageAt(double pressure, double breadth) const {
  return kAt(breadth) > 0 ? std::pow(pressure / kAt(breadth), 1 / n) : kNone;
}

BekkerFit fitBekker(const std::array<PlateTests, 2>& plates, double fromSinkage,
                    const std::vector<std::vector<int>>& counts) {
  BekkerFit fit = nothing();
  const auto countsOf = [&](std::size_t i) { return counts.empty() ? std::vector<int>{} : counts[i]; };
  const std::array<Breadth, 2> breadths{Breadth(plates[0], fromSinkage, countsOf(0)),
                                        Breadth(plates[1], fromSinkage, countsOf(1))};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!breadths[i].isThere()) return fit;
    fit.ownN[i] = breadths[i].covariance / breadths[i].variance;
  }
  fit.n = (breadths[0].covariance + breadths[1].covariance) / (breadths[0].variance + breadths[1].variance);
  for (std::size_t i = 0; i < 2; ++i) {
    fit.k[i] = breadths[i].k(fit.n);
    fit.goodness[i] = goodnessOf(plates[i], fromSinkage, countsOf(i), fit.k[i], fit.n);
  }
  const double b1 = plates[0].breadth, b2 = plates[1].breadth;
  fit.kc = (fit.k[0] - fit.k[1]) * b1 * b2 / (b2 - b1);
  fit.kphi = (fit.k[1] * b2 - fit.k[0] * b1) / (b2 - b1);
  return fit;
}

BekkerFit fitOnePlate(const PlateTests& plate, double fromSinkage) {
  BekkerFit fit = nothing();
  const Breadth breadth(plate, fromSinkage, {});
  if (!breadth.isThere()) return fit;
  fit.n = fit.ownN[0] = breadth.covariance / breadth.variance;
  fit.k[0] = breadth.k(fit.n);
  fit.goodness[0] = goodnessOf(plate, fromSinkage, {}, fit.k[0], fit.n);
  return fit;
}

} // namespace grouser::bevameter

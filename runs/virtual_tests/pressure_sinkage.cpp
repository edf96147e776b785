// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/pressure_sinkage.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::virtual_tests {

namespace {

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

bool counts(const PlateTests& plate, std::size_t curve, std::size_t i) {
  return plate.curves[curve].sinkage[i] > 0 && plate.curves[curve].pressure[i] > 0;
}

int timesOf(const std::vector<int>& counts, std::size_t curve) { return counts.empty() ? 1 : counts[curve]; }

/// The tests of a breadth. Each test has its own k in the fit of n: all tests end at the same pressure, so that a
/// common line through stiff and soft tests would be too flat.
struct Breadth {
  std::vector<std::pair<Sums, double>> tests; ///< sums and multiplicity of each test
  double covariance = 0, variance = 0, times = 0;

  Breadth(const PlateTests& plate, const std::vector<int>& counted) {
    for (std::size_t c = 0; c < plate.curves.size(); ++c) {
      Sums sums;
      for (std::size_t i = 0; timesOf(counted, c) > 0 && i < plate.curves[c].sinkage.size(); ++i)
        if (counts(plate, c, i)) sums.add(plate.curves[c].sinkage[i], plate.curves[c].pressure[i]);
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
double goodnessOf(const PlateTests& plate, const std::vector<int>& times, double k, double n) {
  double squares = 0, sum = 0, points = 0;
  for (std::size_t c = 0; c < plate.curves.size(); ++c)
    for (std::size_t i = 0; timesOf(times, c) > 0 && i < plate.curves[c].sinkage.size(); ++i)
      if (counts(plate, c, i)) {
        const double p = plate.curves[c].pressure[i], difference = p - k * std::pow(plate.curves[c].sinkage[i], n);
        squares += timesOf(times, c) * difference * difference, sum += timesOf(times, c) * p;
        points += timesOf(times, c);
      }
  return points > 2 ? 1 - std::sqrt(squares / (points - 2)) / (sum / points) : base::kNaN;
}

// Range of the starts of the straight lines, their length, and the increment of the starts, all / greatest pressure.
constexpr double kFirst = 0.02, kLast = 0.6, kSpan = 0.2, kStride = 0.02;

/// p = slope (z - origin) by least squares over points [from, to).
struct Straight {
  double slope = 0, origin = 0;
  std::size_t from = 0;
};
Straight straightThrough(const SinkageCurve& curve, std::size_t from, std::size_t to) {
  double n = 0, z = 0, p = 0, zz = 0, zp = 0;
  for (std::size_t i = from; i < to; ++i) {
    const double x = curve.sinkage[i], y = curve.pressure[i];
    n += 1, z += x, p += y, zz += x * x, zp += x * y;
  }
  const double slope = (n * zp - z * p) / (n * zz - z * z);
  return {slope, z / n - p / (n * slope), from};
}

/// Index of the first point with at least this pressure; the size of the curve if there is none.
std::size_t firstWith(const SinkageCurve& curve, double pressure) {
  std::size_t i = 0;
  while (i < curve.pressure.size() && curve.pressure[i] < pressure) ++i;
  return i;
}

BekkerFit nothing() {
  return {
      base::kNaN, base::kNaN, base::kNaN, {base::kNaN, base::kNaN}, {base::kNaN, base::kNaN}, {base::kNaN, base::kNaN}};
}

} // namespace

BeddedCurve correctedForBedding(const SinkageCurve& measured, double room) {
  constexpr std::size_t kMin = 3; // minimum number of points
  BeddedCurve bedded{measured, 0};
  if (measured.pressure.empty()) return bedded;
  const double most = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  const std::size_t first = firstWith(measured, kFirst * most);
  Straight steepest;
  double begins = 0;
  for (int k = 0; kFirst + kStride * k <= kLast; ++k) {
    const double share = kFirst + kStride * k;
    const std::size_t from = firstWith(measured, share * most), to = firstWith(measured, (share + kSpan) * most);
    if (to < from + kMin || to > measured.pressure.size() || measured.sinkage[from] > measured.sinkage[first] + room)
      continue;
    const Straight line = straightThrough(measured, from, to);
    if (std::isfinite(line.slope) && line.slope > steepest.slope) steepest = line, begins = share;
  }
  if (steepest.slope <= 0) return bedded;
  bedded.origin = steepest.origin, bedded.begins = begins;
  for (std::size_t i = 0; i < measured.sinkage.size(); ++i)
    bedded.curve.sinkage[i] = i < steepest.from ? std::max(0.0, measured.pressure[i]) / steepest.slope
                                                : measured.sinkage[i] - steepest.origin;
  return bedded;
}

SinkageCurve fromFirstContact(const SinkageCurve& measured) {
  if (measured.pressure.empty()) return {};
  return fromContactPressure(measured, kFirst * *std::max_element(measured.pressure.begin(), measured.pressure.end()));
}

SinkageCurve fromContactPressure(const SinkageCurve& measured, double pressure, double at) {
  SinkageCurve curve;
  const double contact = contactSinkage(measured, pressure);
  for (std::size_t i = firstWith(measured, pressure); i < measured.sinkage.size(); ++i) {
    curve.sinkage.push_back(measured.sinkage[i] - contact + at);
    curve.pressure.push_back(measured.pressure[i]);
  }
  return curve;
}

double contactSinkage(const SinkageCurve& measured, double pressure) {
  const std::size_t first = firstWith(measured, pressure);
  return first < measured.sinkage.size() ? measured.sinkage[first] : base::kNaN;
}

double BekkerFit::sinkageAt(double pressure, double breadth) const {
  return kAt(breadth) > 0 ? std::pow(pressure / kAt(breadth), 1 / n) : base::kNaN;
}

BekkerFit fitBekker(const std::array<PlateTests, 2>& plates, const std::vector<std::vector<int>>& counts,
                    std::optional<double> givenN) {
  BekkerFit fit = nothing();
  const auto countsOf = [&](std::size_t i) { return counts.empty() ? std::vector<int>{} : counts[i]; };
  const std::array<Breadth, 2> breadths{Breadth(plates[0], countsOf(0)), Breadth(plates[1], countsOf(1))};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!breadths[i].isThere()) return fit;
    fit.ownN[i] = breadths[i].covariance / breadths[i].variance;
  }
  const double best = (breadths[0].covariance + breadths[1].covariance) / (breadths[0].variance + breadths[1].variance);
  fit.n = givenN.value_or(best);
  for (std::size_t i = 0; i < 2; ++i) {
    fit.k[i] = breadths[i].k(fit.n);
    fit.goodness[i] = goodnessOf(plates[i], countsOf(i), fit.k[i], fit.n);
  }
  const double b1 = plates[0].breadth, b2 = plates[1].breadth;
  fit.kc = (fit.k[0] - fit.k[1]) * b1 * b2 / (b2 - b1);
  fit.kphi = (fit.k[1] * b2 - fit.k[0] * b1) / (b2 - b1);
  return fit;
}

BekkerFit fitOnePlate(const PlateTests& plate, const std::vector<int>& counts, std::optional<double> givenN) {
  BekkerFit fit = nothing();
  const Breadth breadth(plate, counts);
  if (!breadth.isThere()) return fit;
  fit.ownN[0] = breadth.covariance / breadth.variance;
  fit.n = givenN.value_or(fit.ownN[0]);
  fit.k[0] = breadth.k(fit.n);
  fit.goodness[0] = goodnessOf(plate, counts, fit.k[0], fit.n);
  return fit;
}

double meanPressureBetween(const SinkageCurve& curve, double from, double to) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < curve.sinkage.size(); ++i)
    if (curve.sinkage[i] > from && curve.sinkage[i] <= to) sum += curve.pressure[i], ++count;
  return sum / count;
}

} // namespace grouser::virtual_tests

// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/time_law.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <cmath>
#include <cstddef>
#include <string>

namespace grouser::multibody {

namespace {

/// A polynomial piece from `start` to `end`, with the value a + b s + c s^2 + d s^3 at s = t - start.
struct Piece {
  double start, end, a, b, c, d;
};

double pieceIntegral(const Piece& p, double s) { return s * (p.a + s * (p.b / 2 + s * (p.c / 3 + s * (p.d / 4)))); }

/// Second derivatives M of the cubic spline with slope 0 at both ends, so that the rate does not jump where the spline
/// meets the constants outside: h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 (slope_i - slope_{i-1}),
/// with h = slope = 0 outside the table (de Boor 1978, A Practical Guide to Splines, ch. IV).
std::vector<double> secondDerivatives(const TimeLaw::Table& t) {
  const std::size_t n = t.times.size();
  std::vector<double> M(n, 0.0), diagonal(n, 1.0);
  const auto h = [&](std::size_t i) { return i + 1 < n ? t.times[i + 1] - t.times[i] : 0.0; };
  const auto slope = [&](std::size_t i) { return i + 1 < n ? (t.values[i + 1] - t.values[i]) / h(i) : 0.0; };
  diagonal[0] = 2 * h(0), M[0] = 6 * slope(0);
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = h(i - 1) / diagonal[i - 1];
    diagonal[i] = 2 * (h(i - 1) + h(i)) - factor * h(i - 1);
    M[i] = 6 * (slope(i) - slope(i - 1)) - factor * M[i - 1];
  }
  M[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) M[i] = (M[i] - h(i) * M[i + 1]) / diagonal[i];
  return M;
}

/// Calls `f` in order for the pieces of a table, including its constant ends, starting at the first piece that ends
/// after `from`.
template <class F> void forEachPiece(const TimeLaw::Table& t, bool smooth, F f) {
  const std::size_t n = t.times.size();
  if (n == 0) return;
  const double far = 1e300;
  f(Piece{-far, t.times[0], t.values[0], 0, 0, 0});
  const std::vector<double> M = smooth ? secondDerivatives(t) : std::vector<double>(n, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = t.times[i + 1] - t.times[i], slope = (t.values[i + 1] - t.values[i]) / h;
    if (h == 0) continue; // a jump
    f(Piece{t.times[i], t.times[i + 1], t.values[i], slope - h * (2 * M[i] + M[i + 1]) / 6, M[i] / 2,
            (M[i + 1] - M[i]) / (6 * h)});
  }
  f(Piece{t.times[n - 1], far, t.values[n - 1], 0, 0, 0});
}

/// Piece that contains time t; at a breakpoint, the earlier piece.
Piece pieceAt(const TimeLaw::Table& table, bool smooth, double t) {
  Piece found{0, 0, 0, 0, 0, 0};
  bool done = false;
  forEachPiece(table, smooth, [&](const Piece& p) {
    if (!done && t <= p.end) found = p, done = true;
  });
  return found;
}

double tableIntegral(const TimeLaw::Table& table, bool smooth, double t) {
  double sum = 0;
  const double low = t < 0 ? t : 0, high = t < 0 ? 0 : t;
  forEachPiece(table, smooth, [&](const Piece& p) {
    const double from = p.start > low ? p.start : low, to = p.end < high ? p.end : high;
    if (!(from < to)) return;
    if (p.b == 0 && p.c == 0 && p.d == 0)
      sum += p.a * (to - from);
    else
      sum += pieceIntegral(p, to - p.start) - pieceIntegral(p, from - p.start);
  });
  return t < 0 ? -sum : sum;
}

std::string tableFault(const char* key, const TimeLaw::Table& t, bool jumps) {
  const std::string name = key;
  if (t.times.empty() && t.values.empty()) return "";
  if (t.times.size() != t.values.size() || t.times.size() < 2)
    return name + " has " + std::to_string(t.times.size()) + " times and " + std::to_string(t.values.size()) +
           " values; set the same number of both, at least 2";
  for (std::size_t i = 0; i < t.times.size(); ++i) {
    if (!std::isfinite(t.times[i]) || !std::isfinite(t.values[i]))
      return name + " has an entry that is not a finite number";
  }
  if (const std::size_t i = firstOutOfOrder(t.times, jumps); i > 0)
    return "the times of its " + name + " must increase, but " + std::to_string(t.times[i]) + " s follows " +
           std::to_string(t.times[i - 1]) + " s";
  return "";
}

} // namespace

bool TimeLaw::empty() const {
  return polynomial.empty() && harmonics.empty() && table.times.empty() && ramps.times.empty();
}

double TimeLaw::value(double t) const {
  double sum = 0;
  for (std::size_t i = polynomial.size(); i-- > 0;) sum = sum * t + polynomial[i];
  for (const Harmonic& h : harmonics) sum += h.amplitude * base::sin(h.frequency * t + h.phase);
  for (const bool smooth : {true, false}) {
    const Table& points = smooth ? table : ramps;
    if (points.times.empty()) continue;
    const Piece p = pieceAt(points, smooth, t);
    const double s = p.b == 0 && p.c == 0 && p.d == 0 ? 0 : t - p.start;
    sum += p.a + s * (p.b + s * (p.c + s * p.d));
  }
  return sum;
}

double TimeLaw::rate(double t) const {
  double sum = 0;
  for (std::size_t i = polynomial.size(); i-- > 1;) sum = sum * t + static_cast<double>(i) * polynomial[i];
  for (const Harmonic& h : harmonics) sum += h.amplitude * h.frequency * base::cos(h.frequency * t + h.phase);
  for (const bool smooth : {true, false}) {
    const Table& points = smooth ? table : ramps;
    if (points.times.empty()) continue;
    const Piece p = pieceAt(points, smooth, t);
    const double s = p.c == 0 && p.d == 0 ? 0 : t - p.start;
    sum += p.b + s * (2 * p.c + s * 3 * p.d);
  }
  return sum;
}

double TimeLaw::acceleration(double t) const {
  double sum = 0;
  for (std::size_t i = polynomial.size(); i-- > 2;) sum = sum * t + static_cast<double>(i * (i - 1)) * polynomial[i];
  for (const Harmonic& h : harmonics)
    sum -= h.amplitude * h.frequency * h.frequency * base::sin(h.frequency * t + h.phase);
  if (!table.times.empty()) {
    const Piece p = pieceAt(table, true, t);
    sum += 2 * p.c + (p.d == 0 ? 0 : 6 * p.d * (t - p.start));
  }
  return sum;
}

double TimeLaw::integral(double t) const {
  double sum = 0;
  for (std::size_t i = polynomial.size(); i-- > 0;) sum = sum * t + polynomial[i] / static_cast<double>(i + 1);
  sum *= t;
  for (const Harmonic& h : harmonics)
    sum += h.frequency == 0 ? h.amplitude * base::sin(h.phase) * t
                            : h.amplitude / h.frequency * (base::cos(h.phase) - base::cos(h.frequency * t + h.phase));
  sum += tableIntegral(table, true, t) + tableIntegral(ramps, false, t);
  return sum;
}

std::string timeLawFault(const TimeLaw& law) {
  for (const double c : law.polynomial)
    if (!std::isfinite(c)) return "a coefficient of its polynomial is not a finite number";
  for (const TimeLaw::Harmonic& h : law.harmonics)
    if (!std::isfinite(h.amplitude) || !std::isfinite(h.frequency) || !std::isfinite(h.phase))
      return "amplitude, frequency or phase of a harmonic is not a finite number";
  const std::string fault = tableFault("table", law.table, false);
  return fault.empty() ? tableFault("ramps", law.ramps, true) : fault;
}

} // namespace grouser::multibody

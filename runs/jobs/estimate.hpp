// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/line_fit.hpp"

#include <span>
#include <string>

/// Statistics of a few seeds: means with intervals, and equality of means within a tolerance.
namespace grouser::jobs {

/// Mean and half width of its 95 % confidence interval (Student's t); infinite for fewer than two values.
support::Estimate interval95(std::span<const double> values);
/// The same for an interval that misses the mean with probability `miss`, in (0, 1).
support::Estimate interval(std::span<const double> values, double miss);
/// Prediction interval: mean, and half width of the interval that misses one further value with probability `miss`.
support::Estimate predictionInterval(std::span<const double> values, double miss);

/// mean b - mean a with its 95 % half width, for independent samples: Welch's interval with Satterthwaite's degrees of
/// freedom, rounded down; infinite if either sample has fewer than two values.
support::Estimate unpairedChange(std::span<const double> a, std::span<const double> b);
/// The same, relative to mean a; ignores the scatter of mean a.
support::Estimate relativeDifference(std::span<const double> a, std::span<const double> b);

/// mean b - mean a with its 95 % half width, for pairs: a[i] and b[i] have the same seed. Throws std::invalid_argument
/// if the numbers of values differ.
support::Estimate pairedChange(std::span<const double> a, std::span<const double> b);
/// The same, relative to mean a; ignores the scatter of mean a.
support::Estimate pairedDifference(std::span<const double> a, std::span<const double> b);

enum class Verdict {
  equal,       ///< the whole interval is within [-bar, bar]
  differs,     ///< the whole interval is outside [-bar, bar]
  inconclusive ///< the interval contains -bar or bar; text: "inconclusive"
};
/// Verdict on a difference: equal if its confidence interval is within [-bar, bar].
Verdict judge(const support::Estimate& difference, double bar);
std::string verdictText(Verdict verdict); ///< "equal", "differs", "inconclusive"

/// Returns true if the half width exceeds the value, so that even the sign is uncertain. False for a single value,
/// which has no interval.
bool isInconclusive(const support::Estimate& estimate);

/// "12.3 +- 0.4" with `digits` digits after the point; "12.3" if the interval is below 1e-9 of the value, so that
/// the seeds agree up to rounding.
std::string plusMinus(const support::Estimate& estimate, int digits);
/// "0.0729 +- 0.0090": two digits of the half width, or three of the value without an interval; one power of ten for
/// both if they are very large or small, or the interval very small; no interval if the seeds agree up to rounding; "-"
/// if the value is not a number.
std::string valueText(const support::Estimate& estimate);
/// "12.3 +- 0.4 %".
std::string percent(const support::Estimate& estimate, int digits = 1);

} // namespace grouser::jobs

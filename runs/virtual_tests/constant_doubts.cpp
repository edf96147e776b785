// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/constant_doubts.hpp"

#include "runs/jobs/estimate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace grouser::virtual_tests {

namespace {

/// Range of a constant in published soils; isClosed: the range includes its lower end.
struct SoilRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool isClosed = false;
  const char* words = "";
};

SoilRange rangeOf(Quantity quantity) {
  switch (quantity) {
  case Quantity::exponent:
    return {0.1, 2, true, "outside [0.1, 2], the range measured in soils"};
  case Quantity::frictionModulus:
    return {0, std::numeric_limits<double>::infinity(), false, "not positive: a wide plate would carry no load"};
  case Quantity::shearModulus:
    return {0, std::numeric_limits<double>::infinity(), false, "not positive"};
  case Quantity::frictionAngle:
    return {0, 60, false, "outside (0, 60] degrees, the range measured in soils"};
  case Quantity::repose:
    return {0, 90, false, "outside (0, 90) degrees"};
  default:
    return {};
  }
}

} // namespace

std::string doubtOf(Quantity quantity, const support::Estimate& measured) {
  if (!std::isfinite(measured.value)) return "not a number";
  const SoilRange range = rangeOf(quantity);
  std::string why;
  const auto add = [&](const std::string& words) { why += (why.empty() ? "" : "; ") + words; };
  if (measured.value < range.low || (!range.isClosed && measured.value == range.low) || measured.value > range.high)
    add(range.words);
  if (quantity == Quantity::cohesion && measured.value + measured.halfWidth < 0) add("negative");
  if (!std::isfinite(measured.halfWidth))
    add("a single test has no interval");
  else if (std::isfinite(range.low) && measured.halfWidth > std::fabs(measured.value))
    add("the interval is wider than the value");
  return why;
}

std::map<Quantity, std::string> doubtsOf(const SoilResults& results) {
  std::map<Quantity, std::string> doubts;
  for (const auto& [quantity, measured] : results.measured)
    if (std::string why = doubtOf(quantity, measured); !why.empty()) doubts[quantity] = std::move(why);
  return doubts;
}

std::string doubtsText(const SoilResults& results, const TestPlan& plan) {
  std::string text;
  bool ofPlates = false;
  for (const auto& [quantity, why] : doubtsOf(results)) {
    text += fmt::format("{}{} = {} {} ({})", text.empty() ? "inconclusive: " : ", ", symbolOf(quantity),
                        jobs::valueText(results.measured.at(quantity)), unitOf(quantity), why);
    ofPlates = ofPlates || quantity == Quantity::exponent || quantity == Quantity::frictionModulus ||
               quantity == Quantity::cohesionModulus;
  }
  if (text.empty()) return text;
  const bool isShort = ofPlates && plan.options.largeSeeds < plan.options.seeds;
  return text + fmt::format("; raise {}{}",
                            isShort    ? "--large-seeds"
                            : ofPlates ? "--seeds and --large-seeds"
                                       : "--seeds",
                            plan.options.coarse ? ", or remove --quick" : "");
}

} // namespace grouser::virtual_tests

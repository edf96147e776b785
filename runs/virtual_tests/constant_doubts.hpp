// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/results.hpp"

#include <map>
#include <string>

/// Measured constants that are implausible, or too uncertain to be used.
namespace grouser::virtual_tests {

/// Reason why a measured constant, in unitOf(quantity), is inconclusive: no number, no interval, one wider than a value
/// that must be positive, or outside the range of measured soils: n in [0.1, 2] (Wong 2008 and Bekker 1969 list 0.1
/// to 1.8), k_phi and K above 0, phi in (0, 60] degrees, repose in (0, 90), c not below 0 by more than its interval.
/// k_c may have either sign. Empty if valid.
std::string doubtOf(Quantity quantity, const support::Estimate& measured);

/// Reasons why measured constants are inconclusive, by quantity; valid constants are absent.
std::map<Quantity, std::string> doubtsOf(const SoilResults& results);

/// "inconclusive: k_phi = -1049 +- ? kN/m^(n+2) (not positive; ...), ...; REMEDY": one line for all; empty if there are
/// none.
std::string doubtsText(const SoilResults& results, const TestPlan& plan);

} // namespace grouser::virtual_tests

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/results.hpp"

#include <map>
#include <string>

/// Measured constants that are implausible, or too uncertain to be used.
namespace grouser::virtual_tests {

/// Reason why a measured constant, in unitOf(quantity), is inconclusive; empty if it is valid. Reasons: it is not a
/// number; it has no interval; it must be positive, but its interval is wider than its value; or it is out of range:
/// n in [0.1, 2] (Wong 2008 and Bekker 1969 list 0.1 to 1.8), k_phi and K above 0, phi in (0, 60] degrees, repose in
/// (0, 90) degrees, c not below 0 by more than its interval. k_c may have either sign.
std::string doubtOf(Quantity quantity, const support::Estimate& measured);

/// Reasons why measured constants are inconclusive, by quantity; valid constants are absent.
std::map<Quantity, std::string> doubtsOf(const SoilResults& results);

/// "inconclusive: k_phi = -1049 +- ? kN/m^(n+2) (not positive; ...), ...; REMEDY": one line for all inconclusive
/// constants; empty if all constants are valid.
std::string doubtsText(const SoilResults& results, const TestPlan& plan);

} // namespace grouser::virtual_tests

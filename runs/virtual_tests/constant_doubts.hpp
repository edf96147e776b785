// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/results.hpp"

#include <map>
#include <string>

/// Which measured constants are none of a soil's, or are not known well enough to be used.
namespace grouser::virtual_tests {

/// Why a measured constant, in unitOf(quantity), is inconclusive: it is no number, has no interval, has one wider than
/// itself where it can only be positive, or lies outside all that soils have been measured to have: n in [0.1, 2]
/// (Wong 2008 and Bekker 1969 list 0.1 to 1.8), k_phi and K above 0, phi in (0, 60] degrees, repose in (0, 90), c not
/// below 0 by more than its interval. k_c may have either sign. Empty where it is sound.
std::string doubtOf(Quantity quantity, const support::Estimate& measured);

/// Reasons to doubt measured constants, by quantity; sound constants are absent.
std::map<Quantity, std::string> doubtsOf(const SoilResults& results);

/// "inconclusive: k_phi = -1049 +- ? kN/m^(n+2) (not positive; ...), ...; REMEDY": one line for all of them; empty
/// where there are none.
std::string doubtsText(const SoilResults& results, const TestPlan& plan);

} // namespace grouser::virtual_tests

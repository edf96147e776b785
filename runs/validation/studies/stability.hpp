// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Stable time steps of the multibody solver against theory.
namespace grouser::studies {

/// One run at one step size.
struct StabilityPoint {
  std::string what;       ///< "spring x 1e3"
  std::string integrator; ///< "rattle2, springs explicit"
  double limit = 0;       ///< longest stable step in theory [s]; may be infinite
  double step = 0;        ///< [s]
  bool predicted = true;  ///< stable
  bool stable = true;
  bool refused = false; ///< rejected by the program with an error that names the limit
  bool agrees() const { return stable == predicted; }
};

/// A spring on a slide with stiffness factors 1e-3 to 1e6; a chain with a tip of 1 to 1e6 link masses; a free top with
/// ratios of moments of 1 to 1e4.
std::vector<StabilityPoint> studyStability();

std::string stabilityTable(const std::vector<StabilityPoint>& points);
std::string stabilityCsv(const std::vector<StabilityPoint>& points);

} // namespace grouser::studies

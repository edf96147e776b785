// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Compares the stable time steps of the multibody solver with theory.
namespace grouser::studies {

/// A run at one step size.
struct StabilityPoint {
  std::string what;       ///< name of the mechanism, e.g. "spring x 1e3"
  std::string integrator; ///< e.g. "rattle2, springs explicit"
  double limit = 0;       ///< longest stable step in theory [s]; may be infinite
  double step = 0;        ///< [s]
  bool predicted = true;  ///< theory predicts a stable run
  bool stable = true;
  bool refused = false; ///< the program rejected the step with an error message that states the limit
  bool agrees() const { return stable == predicted; }
};

/// Runs a spring on a slide with stiffness factors from 1e-3 to 1e6, a chain with a tip of 1 to 1e6 link masses, and a
/// free top with ratios of its moments of inertia from 1 to 1e4.
std::vector<StabilityPoint> studyStability();

std::string stabilityTable(const std::vector<StabilityPoint>& points);
std::string stabilityCsv(const std::vector<StabilityPoint>& points);

} // namespace grouser::studies

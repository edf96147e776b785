// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// Which steps the multibody solver takes, against what theory says.
namespace grouser::studies {

/// One run of many steps.
struct StabilityPoint {
  std::string what;       ///< "spring x 1e3"
  std::string integrator; ///< "rattle2, springs explicit"
  double limit = 0;       ///< longest step that theory allows [s]; infinite where it allows any
  double step = 0;        ///< [s]
  bool predicted = true;  ///< stable
  bool stable = true;
  bool refused = false; ///< by the program, with an error that names the limit
  bool agrees() const { return stable == predicted; }
};

/// A spring on a slide, 1e-3 to 1e6 times as stiff; a chain with a tip of 1 to 1e6 times a link's mass; a free top
/// whose moments are as 1 to 1 to 1e4.
std::vector<StabilityPoint> studyStability();

std::string stabilityTable(const std::vector<StabilityPoint>& points);
std::string stabilityCsv(const std::vector<StabilityPoint>& points);

} // namespace grouser::studies

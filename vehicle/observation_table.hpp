// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/observers.hpp"

#include <string>
#include <vector>

namespace grouser::vehicle {

/// Observed quantity of the output files.
struct Quantity {
  std::string path; ///< "vehicle/left/tension"
  std::string unit; ///< "N"; "-": dimensionless
  std::string help;
  int width = 1; ///< values per row: 1, 3 for a vector, or one per shoe
  std::vector<std::string>
      columns; ///< names of vector components, or wheel numbers; empty for scalars and per-shoe values
};

/// Quantities of an observation of a vehicle, in the order of flatten(). `shoeForces`: include per-shoe forces.
std::vector<Quantity> quantities(const Assembly& vehicle, bool shoeForces = false);
/// Quantities of the whole vehicle, and of one track; `side`: "left" or "right".
std::vector<Quantity> quantitiesOfHull();
std::vector<Quantity> quantitiesOfTrack(const std::string& side, int shoes, int wheels, bool shoeForces = false);

/// Values of an observation as a flat array, `width` values per quantity.
std::vector<double> flatten(const Observation& observation, bool shoeForces = false);

} // namespace grouser::vehicle

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/observers.hpp"

#include <string>
#include <vector>

namespace grouser::vehicle {

/// One observed quantity as an output file wants it.
struct Quantity {
  std::string path; ///< "vehicle/left/tension"
  std::string unit; ///< "N"; "-" where dimensionless
  std::string help;
  int width = 1;                    ///< numbers a row: 3 of a vector, one a shoe
  std::vector<std::string> columns; ///< names of a vector's components, or of wheels by their numbers; empty for
                                    ///< scalars and for one a shoe
};

/// What an observation of this vehicle holds, in the order of flatten(). `shoeForces`: with the force on each shoe.
std::vector<Quantity> quantities(const Assembly& vehicle, bool shoeForces = false);
/// The same in parts: of the whole vehicle, and of each track; `side` is "left" or "right".
std::vector<Quantity> quantitiesOfHull();
std::vector<Quantity> quantitiesOfTrack(const std::string& side, int shoes, int wheels, bool shoeForces = false);

/// The numbers of an observation, each quantity's `width` numbers in turn.
std::vector<double> flatten(const Observation& observation, bool shoeForces = false);

} // namespace grouser::vehicle

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

namespace grouser::support {

/// What a scene's material has of a soil: for results and messages, which know no scene.
struct SoilUse {
  std::string material;
  std::string soil, file, hash;
  bool calibrated = false;
  double grainRadius = 0;                 ///< [m] that it is scaled to
  double scale = 1;                       ///< [-] over the radius of the soil's file
  std::map<std::string, double> scaled{}; ///< what goes with the radius, by key and unit: "cohesion [J/m2]"
};

} // namespace grouser::support

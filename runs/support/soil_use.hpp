// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

namespace grouser::support {

/// Soil of a scene's material, for results and messages.
struct SoilUse {
  std::string material;
  std::string soil, file, hash;
  bool calibrated = false;
  double grainRadius = 0;                 ///< [m] grain radius to which the soil is scaled
  double scale = 1;                       ///< [-] grainRadius / grain radius of the soil file
  std::map<std::string, double> scaled{}; ///< values scaled with the radius, by key and unit: "cohesion [J/m2]"
};

} // namespace grouser::support

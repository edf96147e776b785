// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/vehicle_trial.hpp"

#include <string>
#include <vector>

/// Stability maps of the vehicle: what is run at which place of which map, and the limits that are predicted there.
namespace grouser::studies {

/// A place of a map: a scene, run at `step` and at a quarter of it.
struct MapPoint {
  double x = 0, y = 0; ///< as drawn
  VehicleCase what;
  double step = 0; ///< [s]
};

/// A line that theory or the program itself draws through a map.
struct PredictedLine {
  std::string label;
  std::vector<double> x, y;
};

struct StabilityAxis {
  std::string label; ///< with its unit
  bool logarithmic = true;
};

struct VehicleMap {
  std::string name; ///< of --maps
  std::string title;
  StabilityAxis x, y;
  bool onBed = false; ///< grains: means alone are compared
  std::vector<MapPoint> points{};
  std::vector<PredictedLine> lines{};
};

/// Names of all maps, in their order.
std::vector<std::string> vehicleMapNames();
/// Steps as shares of the longest that the program takes in the scene [-]; the last is beyond.
std::vector<double> mapShares(bool quick);
/// A map with its points and lines. `folder`: for the vehicle files that tell limits. Throws InputError where there is
/// no such map.
VehicleMap vehicleMap(const std::string& name, bool quick, const std::filesystem::path& folder);

} // namespace grouser::studies

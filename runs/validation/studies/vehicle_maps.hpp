// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/vehicle_trial.hpp"

#include <string>
#include <vector>

/// Stability maps of the vehicle: a scene for each point of a map, and predicted limits.
namespace grouser::studies {

/// A point of a map: a scene that is run at `step` and at a quarter of this step.
struct MapPoint {
  double x = 0, y = 0; ///< coordinates in the map
  VehicleCase what;
  double step = 0; ///< [s]
};

/// A limit from theory or from the program, which the plot shows as a line.
struct PredictedLine {
  std::string label;
  std::vector<double> x, y;
};

struct StabilityAxis {
  std::string label; ///< axis label with unit
  bool logarithmic = true;
};

struct VehicleMap {
  std::string name; ///< name for --maps
  std::string title;
  StabilityAxis x, y;
  bool onBed = false; ///< the ground is a bed of grains: only means are compared
  std::vector<MapPoint> points{};
  std::vector<PredictedLine> lines{};
};

/// Names of all maps, in order.
std::vector<std::string> vehicleMapNames();
/// Step / longest step that the program allows in the scene [-]; the last value is above 1.
std::vector<double> mapShares(bool quick);
/// A map with its points and lines. `folder`: folder for temporary vehicle files. Throws InputError if the map is
/// unknown.
VehicleMap vehicleMap(const std::string& name, bool quick, const std::filesystem::path& folder);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/vehicle_trial.hpp"

#include <string>
#include <vector>

/// Stability maps of the vehicle: scenes of the points of each map, and predicted limits.
namespace grouser::studies {

/// A point of a map: a scene, run at `step` and at a quarter of it.
struct MapPoint {
  double x = 0, y = 0; ///< coordinates in the map
  VehicleCase what;
  double step = 0; ///< [s]
};

/// A limit from theory or from the program, drawn as a line.
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
  bool onBed = false; ///< bed of grains: only means are compared
  std::vector<MapPoint> points{};
  std::vector<PredictedLine> lines{};
};

/// Names of all maps, in order.
std::vector<std::string> vehicleMapNames();
/// Steps as fractions of the longest step of the program in the scene [-]; the last one is above it.
std::vector<double> mapShares(bool quick);
/// A map with its points and lines. `folder`: for temporary vehicle files. Throws InputError for an unknown map.
VehicleMap vehicleMap(const std::string& name, bool quick, const std::filesystem::path& folder);

} // namespace grouser::studies

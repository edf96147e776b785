// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/validation/studies/vehicle_maps.hpp"
#include "runs/validation/studies/vehicle_verdict.hpp"

#include <string>
#include <vector>

namespace grouser::studies {

/// `grouser study stability --scene vehicle`.
struct VehicleStability {
  jobs::PieceOptions pieces;
  std::vector<std::string> maps; ///< names; empty: all
};
/// Throws base::SimulationError, after writing all files, if a point is silently wrong or stopped for a wrong cause.
void studyVehicleStability(const VehicleStability& command, const jobs::StudyPlace& place);

/// A point with its runs and verdict.
struct JudgedPoint {
  const VehicleMap* map;
  const MapPoint* point;
  std::vector<TrialPair> pairs; ///< the point's own pair (finer run undefined if rejected), then neighbours
  Judgement judgement;
  const VehicleTrial& run() const { return pairs.front().run; }
  const VehicleTrial& finer() const { return pairs.front().finer; }
};
/// Number of points with this verdict in a map; empty: in all maps.
int pointsOf(const std::vector<JudgedPoint>& points, const std::string& map, MapVerdict verdict);
std::string vehicleMapsCsv(const std::vector<JudgedPoint>& points);
std::string predictedLinesCsv(const std::vector<VehicleMap>& maps);
/// Scatter of the figures between seeds of a bed, with the allowed difference between a run and the one at a quarter of
/// its step; empty unless two points of the map `seeds` are sound.
std::string seedScatterTable(const std::vector<JudgedPoint>& points);
/// Scatter of the figures over neighbouring steps for each point that has some; empty if none has.
std::string neighboursTable(const std::vector<JudgedPoint>& points);
/// One row per neighbouring step, with the figures of both runs.
std::string neighboursCsv(const std::vector<JudgedPoint>& points);
/// One line per map, then the messages of stops, rejections (one of each kind) and wrong points.
std::string vehicleMapsTable(const std::vector<JudgedPoint>& points);

} // namespace grouser::studies

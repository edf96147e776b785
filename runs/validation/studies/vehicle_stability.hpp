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
/// After writing all files, throws base::SimulationError if a point is silently wrong or stopped with a wrong cause.
void studyVehicleStability(const VehicleStability& command, const jobs::StudyPlace& place);

/// A point with its runs and verdict.
struct JudgedPoint {
  const VehicleMap* map;
  const MapPoint* point;
  std::vector<TrialPair> pairs; ///< pair at the step (without `finer` if rejected), then pairs at neighbouring steps
  Judgement judgement;
  const VehicleTrial& run() const { return pairs.front().run; }
  const VehicleTrial& finer() const { return pairs.front().finer; }
};
/// Number of points with this verdict in a map; an empty name means all maps.
int pointsOf(const std::vector<JudgedPoint>& points, const std::string& map, MapVerdict verdict);
std::string vehicleMapsCsv(const std::vector<JudgedPoint>& points);
std::string predictedLinesCsv(const std::vector<VehicleMap>& maps);
/// Scatter of the figures between beds with different seeds, and the allowed difference between a run and the run at a
/// quarter of its step; empty unless at least two points of the map `seeds` are sound.
std::string seedScatterTable(const std::vector<JudgedPoint>& points);
/// Scatter of the figures over neighbouring steps, for each point with such runs; empty if there are no such points.
std::string neighboursTable(const std::vector<JudgedPoint>& points);
/// CSV of the figures of all runs of the points with neighbouring steps.
std::string neighboursCsv(const std::vector<JudgedPoint>& points);
/// One line per map, then the messages of stops and rejections (one of each kind) and of wrong points.
std::string vehicleMapsTable(const std::vector<JudgedPoint>& points);

} // namespace grouser::studies

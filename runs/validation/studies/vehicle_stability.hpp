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
/// Throws base::SimulationError, after all is written, where a point is silently wrong or stopped for a wrong cause.
void studyVehicleStability(const VehicleStability& command, const jobs::StudyPlace& place);

/// A point and what became of it.
struct JudgedPoint {
  const VehicleMap* map;
  const MapPoint* point;
  std::vector<TrialPair> pairs; ///< the point's own, whose finer run has no meaning where it was refused; neighbours
  Judgement judgement;
  const VehicleTrial& run() const { return pairs.front().run; }
  const VehicleTrial& finer() const { return pairs.front().finer; }
};
/// Of a map; of all where it is empty.
int pointsOf(const std::vector<JudgedPoint>& points, const std::string& map, MapVerdict verdict);
std::string vehicleMapsCsv(const std::vector<JudgedPoint>& points);
std::string predictedLinesCsv(const std::vector<VehicleMap>& maps);
/// How far the figures of a bed's runs lie apart that differ by their seed alone, beside what a run may differ from the
/// one at a quarter of its step; empty unless two points of the map `seeds` are sound.
std::string seedScatterTable(const std::vector<JudgedPoint>& points);
/// Of each point that has neighbours how its figures scatter over them; empty where none has.
std::string neighboursTable(const std::vector<JudgedPoint>& points);
/// A row a neighbouring step, with the figures of both runs.
std::string neighboursCsv(const std::vector<JudgedPoint>& points);
/// A line a map, then each stop, each refusal of its kind, and each point that is wrong, in words.
std::string vehicleMapsTable(const std::vector<JudgedPoint>& points);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/drive_record.hpp"

#include "runs/setup/drive_length.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace grouser::commands {

DriveRecord::DriveRecord(const std::vector<output::Channel>& channels) {
  std::size_t at = 0;
  for (const output::Channel& c : channels) {
    if (c.path == "vehicle/left/teeth_passed") at_[0] = at;
    if (c.path == "vehicle/right/teeth_passed") at_[1] = at;
    at += static_cast<std::size_t>(c.width);
  }
}

void DriveRecord::add(const output::Row& row) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!at_[side]) continue;
    const double now = row.values[*at_[side]];
    if (begun_) passed_[side] += std::fabs(now - last_[side]);
    last_[side] = now;
  }
  begun_ = true;
}

std::string incompleteText(const scene::Scene& scene, const simulation::Simulation& simulation, double teeth) {
  const simulation::VehicleRig* rig = simulation.vehicle();
  if (!rig || !setup::asksToDrive(scene)) return {};
  const std::optional<double> start = rig->driveStart();
  const bool drove = start && *start < simulation.time() && teeth >= setup::kLeastTeeth;
  if (drove && teeth >= setup::kFewestTeeth) return {};
  const bool waited = simulation.setup().vehicle->driver.rest.has_value();
  const std::string when =
      !start ? fmt::format("it had not come to rest by the end of the run, {:.4g} s", simulation.time())
             : fmt::format("{} at {:.4g} s of {:.4g} s", waited ? "it came to rest" : "its sprockets start", *start,
                           simulation.time());
  return fmt::format("the vehicle {} ({}){}; {}",
                     drove ? fmt::format("drove {:.2g} teeth, fewer than {:g}", teeth, setup::kFewestTeeth)
                           : "never drove",
                     when, drove ? ", and its figures are inconclusive" : "",
                     rig->ended().empty() ? setup::longerDriveRemedy(scene) : "let [stop] end the run later");
}

void describeDrive(const scene::Scene& scene, const simulation::Simulation& simulation, double teeth,
                   output::RunWriter& writer, output::Summary& summary) {
  if (!simulation.vehicle()) return;
  summary.incomplete = incompleteText(scene, simulation, teeth);
  if (!summary.incomplete.empty()) fmt::print("WARNING: {}\n", summary.incomplete);
  const std::optional<double> start = simulation.vehicle()->driveStart();
  if (start) summary.figures["drive_start_s"] = *start;
  if (start && *start <= simulation.time()) fmt::print("drive     from {:.6g} s on\n", *start);
  if (const std::string& end = simulation.vehicle()->ended(); !end.empty()) {
    fmt::print("ended     at {:.6g} s by {}\n", simulation.time(), end);
    writer.fact("ended_by", end);
  }
  const vehicle::BlowMeter blows = simulation.vehicle()->observe().blows;
  summary.figures["ground_force_most_over_weight"] = blows.most;
  if (blows.isBlow()) fmt::print("blows     {}\n", blows.text());
}

} // namespace grouser::commands

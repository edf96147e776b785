// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/drive_text.hpp"

#include "runs/setup/drive_length.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace grouser::commands {

std::string incompleteText(const scene::Scene& scene, const coupling::Simulation& simulation, double teeth) {
  const coupling::VehicleRig* rig = simulation.vehicle();
  if (!rig || !setup::commandsDrive(scene)) return {};
  const std::optional<double> start = rig->driveStart();
  const bool drove = start && *start < simulation.time() && teeth >= setup::kMinTeeth;
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

void describeDrive(const scene::Scene& scene, const coupling::Simulation& simulation, double teeth,
                   output::Summary& summary, bool endsAtRest) {
  if (!simulation.vehicle()) return;
  if (!endsAtRest) summary.incomplete = incompleteText(scene, simulation, teeth);
  if (!summary.incomplete.empty()) fmt::print("WARNING: {}\n", summary.incomplete);
  if (const std::optional<double> start = simulation.vehicle()->driveStart(); start && *start <= simulation.time())
    fmt::print("drive     sprockets start at {:.6g} s\n", *start);
  if (const std::string& end = simulation.vehicle()->ended(); !end.empty())
    fmt::print("ended     at {:.6g} s by {}\n", simulation.time(), end);
  if (const vehicle::BlowMeter blows = simulation.vehicle()->observe().blows; blows.isBlow())
    fmt::print("blows     {}\n", blows.text());
}

} // namespace grouser::commands

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_runs.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/campaigns/sweeps/runner.hpp"
#include "runs/output/output.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/folder_use.hpp"
#include "runs/support/json_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace grouser::events {

namespace fs = std::filesystem;

namespace {

/// Plan with the runs of this part only.
sweeps::SweepPlan partOf(const sweeps::SweepPlan& whole, const jobs::Part& part) {
  sweeps::SweepPlan some{whole.scene, whole.keys, {}};
  for (std::size_t i = 0; i < whole.runs.size(); ++i)
    if (part.has(i)) some.runs.push_back(whole.runs[i]);
  return some;
}

} // namespace

fs::path folderOf(const EventsCommand& command, const std::string& what) {
  if (!command.folder.empty()) return command.folder;
  const auto stem = [](const std::string& word) { return fs::path(word).stem().string(); };
  const EventOptions& o = command.options;
  const bool scm = groundOf(o) == scene::TerrainKind::scm;
  return fs::path("out") / fmt::format("{}_{}_{}{}{}", what, stem(o.vehicle), stem(soilWord(o)), scm ? "_scm" : "",
                                       o.quick ? "_quick" : "");
}

EventOptions optionsOfRuns(const EventsCommand& command) {
  EventOptions options = command.options;
  options.frames = command.films;
  if (command.pieces.device != "auto") options.fixed.push_back("run.device=" + command.pieces.device);
  if (command.pieces.threads > 0) options.fixed.push_back(fmt::format("run.threads={}", command.pieces.threads));
  return options;
}

jobs::Recipe recipeOf(const EventsCommand& command, const fs::path& folder, const std::string& axis) {
  const EventOptions& o = command.options;
  const auto given = [](const auto& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json call = {{"vehicle", o.vehicle},
                                 {"soil", soilWord(o)},
                                 {"only", o.only},
                                 {"levels", o.levels},
                                 {"set", o.fixed},
                                 {"speed_m_s", given(o.speed)},
                                 {"grain_radius_m", given(o.grainRadius)},
                                 {"depth_m", given(o.depth)},
                                 {"seeds", given(o.seeds)},
                                 {"quick", o.quick},
                                 {"frames", o.frames}};
  // call.json has no entry for the default ground of a soil.
  if (groundOf(o) == scene::TerrainKind::scm) call["ground"] = base::wordOf(scene::TerrainKind::scm);
  if (o.draws > 0) call["draws"] = o.draws;
  if (o.gravity) call["gravity_m_s2"] = *o.gravity;
  if (!axis.empty()) call["axis"] = axis;
  return {folder / (axis.empty() ? "call.json" : "map_call.json"), support::jsonText(call, 2) + "\n"};
}

void checkFolder(const EventsCommand& command, const fs::path& folder, const jobs::Recipe& call) {
  if (command.plan) return;
  if (command.pieces.part.empty()) support::requireUnused(folder);
  const bool continues = command.pieces.resume || !command.pieces.part.empty() || call.isThere();
  std::error_code unreadable;
  if (!command.force && !continues && fs::is_directory(folder, unreadable) && !fs::is_empty(folder, unreadable))
    throw base::InputError(fmt::format("{}: contains results of a different command; continue with --resume, choose "
                                       "another folder with --out, or repeat all runs with --force",
                                       folder.string()));
  output::checkOutputFolder(folder, command.force || continues);
}

void printHead(const EventsCommand& command, const std::string& what, const EventPlan& plan, std::size_t runs) {
  const VehicleShape& s = plan.course.shape;
  fmt::print("{:<10}{} on {}: commit {}, {}\n", what, command.options.vehicle, plan.groundText(),
             support::buildInfo().commit, support::machineText());
  fmt::print("          {:.0f} kg, centre of mass {:.3f} m high and {:.3f} m ahead of the rear road wheel, "
             "track-ground contact length {:.3f} m, {:g} m/s\n",
             s.mass, s.massCentre.z, s.massCentre.x - s.firstWheel, s.groundRun(), plan.course.speed);
  if (s.gravity != kGravity) fmt::print("          gravity {:g} m/s2\n", s.gravity);
  if (plan.course.granular())
    fmt::print("          bed depth {:.3g} m, grain diameter {:.3g} mm, {:.1f} grains per pad width; {}{}\n",
               plan.course.depth, 2e3 * plan.grainRadius, plan.course.shape.padWidth / (2 * plan.grainRadius),
               base::counted(plan.seeds, "seed"), command.options.quick ? "; coarse settings (--quick)" : "");
  if (plan.draws > 0)
    fmt::print(
        "          {} of the soil constants: +- is the half width of the 95 % prediction interval for one more draw\n",
        base::counted(plan.draws, "draw"));
  if (plan.shoesAlone()) fmt::print("          {}\n", kShoesOnly);
  for (const auto& [event, why] : plan.omitted) fmt::print("          {} skipped: {}\n", base::wordOf(event), why);
  fmt::print("          {}\n", base::counted(runs, "run"));
  std::fflush(stdout);
}

nlohmann::ordered_json headJson(const EventsCommand& command, const EventPlan& plan) {
  return {{"command", command.words},
          {"machine", support::machineText()},
          {"commit", support::buildInfo().commit},
          {"vehicle", command.options.vehicle},
          {"soil", soilWord(command.options)},
          {"ground", base::wordOf(plan.course.ground)},
          {"quick", command.options.quick},
          {"seeds", plan.seeds},
          {"draws", plan.draws},
          {"speed_m_s", plan.course.speed},
          {"gravity_m_s2", plan.course.shape.gravity},
          {"grain_radius_m", plan.grainRadius},
          {"bed_depth_m", plan.course.depth},
          {"soil_touches_shoes_only", plan.shoesAlone()}};
}

std::vector<sweeps::SweepOutcome> doRuns(const EventsCommand& command, const std::string& what,
                                         const sweeps::SweepPlan& plan, const fs::path& folder,
                                         const jobs::Recipe& call) {
  sweeps::SweepOptions sweep;
  sweep.program = fs::read_symlink("/proc/self/exe");
  sweep.folder = folder, sweep.jobs = command.jobs, sweep.seconds = command.pieces.seconds;
  sweep.force = command.force, sweep.keepFailures = true, sweep.shared = !command.pieces.part.empty();
  fs::create_directories(folder);
  call.keep();
  auto outcomes = sweeps::runMissing(partOf(plan, command.pieces.share()), sweep, what,
                                     [](const std::vector<sweeps::SweepOutcome>&) {});
  fmt::print("{}", sweeps::noticesText(sweeps::runNotices(plan, folder), plan.runs.size()));
  if (command.pieces.part.empty()) return outcomes;
  fmt::print("part      {} of the runs; to write the tables, repeat the command with --resume and without --part\n",
             command.pieces.part);
  return {};
}

void throwOnUnknownFailures(const std::vector<EventRow>& rows, const fs::path& table) {
  int unknown = 0;
  std::size_t runs = 0;
  for (const EventRow& row : rows) unknown += row.unknown, runs += row.each.size();
  if (unknown > 0)
    throw base::SimulationError(fmt::format("{} of {} runs failed for reasons unrelated to the vehicle; see {}",
                                            unknown, runs, table.string()));
}

} // namespace grouser::events

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/events.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/campaigns/events/event_forecast.hpp"
#include "runs/campaigns/events/event_report.hpp"
#include "runs/campaigns/sweeps/runner.hpp"
#include "runs/output/output.hpp"
#include "runs/output/plots.hpp"
#include "runs/render/film.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/program_call.hpp"
#include "runs/support/tell.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace grouser::events {

namespace fs = std::filesystem;

namespace {

constexpr const char* kCall = "call.json"; // options of the call that wrote the folder
constexpr const char *kTable = "events.csv", *kJson = "events.json", *kText = "events.txt", *kPlot = "events.png",
                     *kPictures = "pictures.png", *kDrawbar = "drawbar.png";

fs::path folderOf(const EventsCommand& command) {
  if (!command.folder.empty()) return command.folder;
  const auto stem = [](const std::string& word) { return fs::path(word).stem().string(); };
  const EventOptions& o = command.options;
  const bool scm = groundOf(o) == scene::TerrainKind::scm;
  return fs::path("out") / fmt::format("events_{}_{}{}{}", stem(o.vehicle), stem(soilWord(o)), scm ? "_scm" : "",
                                       o.quick ? "_quick" : "");
}

void printHead(const EventsCommand& command, const EventPlan& plan) {
  const VehicleShape& s = plan.course.shape;
  fmt::print("events    {} on {}: commit {}, {}\n", command.options.vehicle, plan.groundText(),
             support::buildInfo().commit, support::machineText());
  fmt::print("          {:.0f} kg, centre of mass {:.3f} m high and {:.3f} m before the rearmost of its wheels, ground "
             "run {:.3f} m, {:g} m/s\n",
             s.mass, s.massCentre.z, s.massCentre.x - s.firstWheel, s.groundRun(), plan.course.speed);
  if (plan.course.granular())
    fmt::print("          beds {:.3g} m deep of grains of {:.3g} mm, {:.1f} on the width of a pad; {}{}\n",
               plan.course.depth, 2e3 * plan.grainRadius, plan.course.shape.padWidth / (2 * plan.grainRadius),
               base::counted(plan.seeds, "seed"), command.options.quick ? "; coarse" : "");
  if (plan.shoesAlone()) fmt::print("          {}\n", kShoesAlone);
  for (const auto& [event, why] : plan.omitted) fmt::print("          {} is left out: {}\n", base::wordOf(event), why);
  fmt::print("          {}\n", base::counted(plan.sweep.runs.size(), "run"));
  std::fflush(stdout);
}

/// All that decides which runs there are, as text.
std::string callText(const EventOptions& o) {
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
  // Without this key: the ground that the soil implies.
  if (groundOf(o) == scene::TerrainKind::scm) call["ground"] = base::wordOf(scene::TerrainKind::scm);
  return support::jsonText(call, 2) + "\n";
}

/// The runs of a part. Its trials name runs that are not there.
sweeps::SweepPlan partOf(const sweeps::SweepPlan& whole, const jobs::Part& part) {
  sweeps::SweepPlan some = whole;
  some.runs.clear();
  for (std::size_t i = 0; i < whole.runs.size(); ++i)
    if (part.has(i)) some.runs.push_back(whole.runs[i]);
  return some;
}

/// A film of the first run of each level that has left frames.
void makeFilms(const EventPlan& plan, const fs::path& program, const fs::path& folder) {
  for (const PlannedTrial& planned : plan.trials) {
    const std::string& name = plan.sweep.runs[planned.runs.front()].name;
    const fs::path frames = folder / name / "frames.h5", film = folder / (name + ".mp4");
    std::error_code error;
    if (!fs::exists(frames, error) || fs::exists(film, error)) continue;
    const support::CallOutcome made =
        support::callProgram({program.string(), "render", frames.string(), "--film", film.string(), "--size", "960x540",
                              "--out", (folder / name / "film").string(), "--force"});
    if (made.status == 0)
      fmt::print("film      {}\n", film.string());
    else
      support::tell("grouser: warning: no film of {}: {}\n", name, made.output);
  }
}

void writeTables(const EventsCommand& command, const EventPlan& plan, const std::vector<EventRow>& rows,
                 const fs::path& folder) {
  const std::vector<EventLimit> limits = eventLimits(rows, plan.course);
  const std::string text = eventsText(rows, limits, plan);
  fmt::print("\n{}\n", text);
  nlohmann::ordered_json json = {{"command", command.words},
                                 {"machine", support::machineText()},
                                 {"commit", support::buildInfo().commit},
                                 {"vehicle", command.options.vehicle},
                                 {"soil", soilWord(command.options)},
                                 {"ground", base::wordOf(plan.course.ground)},
                                 {"quick", command.options.quick},
                                 {"seeds", plan.seeds},
                                 {"speed_m_s", plan.course.speed},
                                 {"grain_radius_m", plan.grainRadius},
                                 {"bed_depth_m", plan.course.depth},
                                 {"soil_meets_shoes_alone", plan.shoesAlone()}};
  json.update(eventsJson(rows, limits, plan));
  support::replaceTextFile(folder / kTable, eventsCsv(rows));
  support::replaceTextFile(folder / kText, text);
  support::replaceTextFile(folder / kJson, support::jsonText(json, 2) + "\n");
  for (const char* name : {kTable, kText, kJson}) fmt::print("table     {}\n", (folder / name).string());
  output::drawPicture("events.py", {folder / kJson}, folder / kPlot);
  output::drawPicture("event_drawbar.py", {folder / kJson}, folder / kDrawbar);
  output::drawPicture("event_pictures.py", {folder / kJson}, folder / kPictures);
}

} // namespace

void eventsCommand(const EventsCommand& command) {
  EventOptions options = command.options;
  options.frames = command.films;
  if (command.pieces.device != "auto") options.fixed.push_back("run.device=" + command.pieces.device);
  if (command.pieces.threads > 0) options.fixed.push_back(fmt::format("run.threads={}", command.pieces.threads));
  const fs::path folder = folderOf(command);
  const jobs::Recipe call(folder / kCall, callText(command.options));
  const bool goesOn = command.pieces.resume || !command.pieces.part.empty() || call.isThere();
  std::error_code unreadable;
  if (!command.plan && !command.force && !goesOn && fs::is_directory(folder, unreadable) &&
      !fs::is_empty(folder, unreadable))
    throw base::InputError(fmt::format("{}: the folder holds something else than the runs of this command; go on there "
                                       "with --resume, name another with --out, or run all of it again with --force",
                                       folder.string()));
  if (!command.plan) output::checkOutputFolder(folder, command.force || goesOn);
  const EventPlan plan = planEvents(options);
  if (command.films && !command.plan && command.pieces.part.empty()) render::checkFilmProgram("--films");
  printHead(command, plan);
  if (command.plan) {
    fmt::print("{}", timesText(timesOf(plan, folder)));
    return;
  }
  scene::printNotes(plan.sweep.runs.front().scene);
  sweeps::SweepOptions sweep;
  sweep.program = fs::read_symlink("/proc/self/exe");
  sweep.folder = folder, sweep.jobs = command.jobs, sweep.seconds = command.pieces.seconds;
  sweep.force = command.force, sweep.failuresStay = true, sweep.shared = !command.pieces.part.empty();
  const sweeps::SweepPlan mine = partOf(plan.sweep, command.pieces.share());
  fs::create_directories(folder);
  call.keep();
  const auto outcomes = sweeps::runMissing(mine, sweep, "events", [](const std::vector<sweeps::SweepOutcome>&) {});
  if (!command.pieces.part.empty()) {
    fmt::print("part      {} of the runs; a call with --resume and without --part writes the tables\n",
               command.pieces.part);
    return;
  }
  const std::vector<EventRow> rows = eventRows(plan, outcomes, folder);
  writeTables(command, plan, rows, folder);
  if (command.films) makeFilms(plan, sweep.program, folder);
  int unknown = 0;
  for (const EventRow& row : rows) unknown += row.unknown;
  if (unknown > 0)
    throw base::SimulationError(
        fmt::format("{} of {} runs failed for a cause that is not the vehicle's; their messages stand in {}", unknown,
                    plan.sweep.runs.size(), (folder / kText).string()));
}

} // namespace grouser::events

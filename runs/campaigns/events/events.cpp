// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/events.hpp"

#include "base/counted.hpp"
#include "base/error.hpp"
#include "runs/campaigns/events/event_forecast.hpp"
#include "runs/campaigns/events/event_report.hpp"
#include "runs/campaigns/events/event_runs.hpp"
#include "runs/campaigns/events/other_events.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/output/output.hpp"
#include "runs/output/plots.hpp"
#include "runs/render/film.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/program_call.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace grouser::events {

namespace fs = std::filesystem;

namespace {

constexpr const char *kTable = "events.csv", *kJson = "events.json", *kText = "events.txt", *kPlot = "events.png",
                     *kPictures = "pictures.png", *kDrawbar = "drawbar.png", *kAgainst = "against.csv",
                     *kAgainstText = "against.txt";

/// Makes a film of the first run of each level, if that run has frames.
void makeFilms(const EventPlan& plan, const fs::path& folder) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
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
      support::printStderr("WARNING: no film of {}: {}\n", name, made.output);
  }
}

void writeTables(const EventsCommand& command, const EventPlan& plan, const std::vector<EventRow>& rows,
                 const fs::path& folder) {
  const std::vector<EventLimit> limits = eventLimits(rows, plan.course);
  const std::string text = eventsText(rows, limits, plan);
  fmt::print("\n{}\n", text);
  nlohmann::ordered_json json = headJson(command, plan);
  json.update(eventsJson(rows, limits, plan));
  json["notices"] = sweeps::noticesJson(sweeps::runNotices(plan.sweep, folder));
  support::replaceTextFile(folder / kTable, eventsCsv(rows));
  support::replaceTextFile(folder / kText, text);
  support::replaceTextFile(folder / kJson, support::jsonText(json, 2) + "\n");
  for (const char* name : {kTable, kText, kJson}) fmt::print("table     {}\n", (folder / name).string());
  output::drawPicture("events.py", {folder / kJson}, folder / kPlot);
  output::drawPicture("event_drawbar.py", {folder / kJson}, folder / kDrawbar);
  output::drawPicture("event_pictures.py", {folder / kJson}, folder / kPictures);
}

void writeAgainst(const EventsCommand& command, const EventSet& here, const std::vector<EventSet>& others) {
  std::error_code absent;
  for (const char* name : {kAgainst, kAgainstText}) fs::remove(here.folder / name, absent); // left by an earlier call
  if (others.empty()) return;
  std::string csv, text;
  for (const EventSet& other : others) {
    const std::vector<FigureDifference> differences = differencesFrom(here, other, command.percent);
    csv += differencesCsv(differences, other, csv.empty());
    text += differencesText(differences, here, other, command.percent) + "\n";
  }
  fmt::print("{}", text);
  support::replaceTextFile(here.folder / kAgainst, csv);
  support::replaceTextFile(here.folder / kAgainstText, text);
  for (const char* name : {kAgainst, kAgainstText}) fmt::print("table     {}\n", (here.folder / name).string());
}

} // namespace

void eventsCommand(const EventsCommand& command) {
  const EventOptions options = optionsOfRuns(command);
  const fs::path folder = folderOf(command, "events");
  const jobs::Recipe call = recipeOf(command, folder);
  checkFolder(command, folder, call);
  std::vector<EventSet> others;
  for (const std::string& other : command.against) others.push_back(readEventSet(other));
  const EventPlan plan = planEvents(options);
  if (command.films && !command.plan && command.pieces.part.empty()) render::checkFilmProgram("--films");
  printHead(command, "events", plan, plan.sweep.runs.size());
  if (command.plan) {
    fmt::print("{}", timesText(timesOf(plan, folder)));
    return;
  }
  sweeps::printNotesOf(plan.sweep);
  const auto outcomes = doRuns(command, "events", plan.sweep, folder, call);
  if (outcomes.empty()) return;
  const std::vector<EventRow> rows = eventRows(plan, outcomes, folder);
  writeTables(command, plan, rows, folder);
  writeAgainst(command, eventSet(folder, command.options.vehicle, plan, rows), others);
  if (command.films) makeFilms(plan, folder);
  throwOnUnknownFailures(rows, folder / kText);
}

} // namespace grouser::events

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/mobility_map.hpp"

#include "base/error.hpp"
#include "runs/campaigns/events/event_forecast.hpp"
#include "runs/campaigns/events/event_runs.hpp"
#include "runs/campaigns/sweeps/run_notices.hpp"
#include "runs/output/plots.hpp"
#include "runs/support/csv_cell.hpp"
#include "runs/support/json_text.hpp"
#include "runs/support/shell_word.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace grouser::events {

namespace fs = std::filesystem;
using base::InputError;

namespace {

constexpr const char *kMapTable = "map.csv", *kMapJson = "map.json", *kMapText = "map.txt", *kMapPlot = "map.png";
/// Keys that have a command-line option, with that option.
constexpr std::pair<const char*, const char*> kOfOptions[] = {
    {"terrain.material", "use --soil"}, {"terrain.kind", "use --ground"}, {sweeps::kSeedKey, "use --seeds"},
    {sweeps::kDrawKey, "use --draws"},  {"run.threads", "use --threads"}, {"run.device", "use --device"}};

/// Runs of all columns in one plan.
sweeps::SweepPlan runsOf(const MobilityMap& map) {
  sweeps::SweepPlan all;
  all.scene = map.columns.front().plan.sweep.scene;
  all.keys = map.columns.front().plan.sweep.keys;
  all.keys.insert(all.keys.begin(), map.key);
  for (const MapColumn& column : map.columns)
    for (sweeps::SweepRun run : column.plan.sweep.runs) {
      run.values.insert(run.values.begin(), column.value);
      all.runs.push_back(std::move(run));
    }
  return all;
}

void judgeColumns(MobilityMap& map, const std::vector<sweeps::SweepOutcome>& outcomes, const fs::path& folder) {
  auto next = outcomes.begin();
  for (MapColumn& column : map.columns) {
    const auto end = next + static_cast<std::ptrdiff_t>(column.plan.sweep.runs.size());
    column.rows = eventRows(column.plan, {next, end}, folder);
    next = end;
  }
}

std::string mapCsv(const MobilityMap& map) {
  std::string text;
  for (const MapColumn& column : map.columns) {
    const std::string csv = eventsCsv(column.rows, {map.key, column.value});
    text += text.empty() ? csv : csv.substr(csv.find('\n') + 1);
  }
  return text;
}

nlohmann::ordered_json mapJson(const MobilityMap& map) {
  nlohmann::ordered_json json = {{"event", base::wordOf(map.event)},
                                 {"title", titleOf(map.event)},
                                 {"level_is", levelText(map.event)},
                                 {"key", map.key},
                                 {"columns", nlohmann::ordered_json::array()}};
  for (const MapColumn& column : map.columns) {
    nlohmann::ordered_json entry = {{"value", column.value}, {"speed_m_s", column.plan.course.speed}};
    entry.update(eventsJson(column.rows, eventLimits(column.rows, column.plan.course), column.plan));
    json["columns"].push_back(entry);
  }
  return json;
}

/// Plan of the event for one value of the axis. Error messages about the key mention --axis.
EventPlan planColumn(const EventOptions& options, const std::string& key, const std::string& value) {
  EventOptions ofColumn = options;
  ofColumn.fixed.push_back(fmt::format("{}={}", key, value));
  try {
    return planEvents(ofColumn);
  } catch (const InputError& error) {
    std::string fault = error.what();
    const std::string ofSet = fmt::format("--set {}", ofColumn.fixed.back());
    if (fault.starts_with(ofSet + ":")) throw InputError("--axis" + fault.substr(std::string("--set").size()));
    const std::size_t named = fault.find(key), begin = fault.find(": ");
    const bool ofKey = named != std::string::npos && begin != std::string::npos && begin < named;
    throw InputError(ofKey ? fmt::format("--axis {}={}: {}", key, value, fault.substr(begin + 2)) : fault);
  }
}

void refuseKey(const std::string& axis, const std::string& key) {
  for (const auto& [other, remedy] : kOfOptions)
    if (key == other) throw InputError(fmt::format("--axis {}: this key has its own option; {}", axis, remedy));
  if (key.starts_with("output."))
    throw InputError(fmt::format("--axis {}: keys of [output] do not affect verdicts; use --set", axis));
}

/// Throws if two runs have the same folder name.
void checkNames(const MobilityMap& map, const std::string& axis) {
  std::set<std::string> names;
  for (const MapColumn& column : map.columns)
    for (const sweeps::SweepRun& run : column.plan.sweep.runs)
      if (!names.insert(run.name).second)
        throw InputError(fmt::format(
            "--axis {}: duplicate run name {}; use values and levels that differ within six digits", axis, run.name));
}

bool sameLevels(const EventPlan& a, const EventPlan& b) {
  return std::equal(a.trials.begin(), a.trials.end(), b.trials.begin(), b.trials.end(),
                    [](const PlannedTrial& x, const PlannedTrial& y) { return x.level == y.level; });
}

/// Estimated run time of all columns, scaled from the first column.
std::vector<EventTime> timesOf(const MobilityMap& map, const fs::path& folder) {
  std::vector<EventTime> times = events::timesOf(map.columns.front().plan, folder);
  const auto columns = static_cast<int>(map.columns.size());
  for (EventTime& time : times) time.runs *= columns, time.here *= columns, time.h200 *= columns;
  return times;
}

} // namespace

MobilityMap planMap(const EventOptions& options, const std::string& axis) {
  if (options.only.size() != 1) throw InputError("map: requires exactly one event; set it with --event");
  MobilityMap map;
  map.event = eventOf(options.only[0]);
  if (levelText(map.event).empty())
    throw InputError(
        fmt::format("--event {}: has no levels to map; use e.g. {}", options.only[0], base::wordOf(Event::grade)));
  const sweeps::KeyValues values = sweeps::keyValues(axis, "--axis", "scm.c=0,1000,2000");
  map.key = values.key;
  refuseKey(axis, map.key);
  if (values.values.size() < 2) {
    planColumn(options, values.key, values.values.front()); // the event may refuse the key
    throw InputError(fmt::format("--axis {}: requires at least two values; for a single value, use: grouser events "
                                 "--only {} --set {}",
                                 axis, options.only[0], support::shellWord(axis)));
  }
  for (const std::string& value : values.values) {
    MapColumn column{value, planColumn(options, values.key, value), {}};
    for (sweeps::SweepRun& run : column.plan.sweep.runs)
      run.name = fmt::format("{}={},{}", sweeps::plainText(values.key), sweeps::plainText(column.value), run.name);
    if (column.plan.trials.size() < 2) throw InputError("--levels: a map requires at least two levels");
    if (!map.columns.empty() && !sameLevels(column.plan, map.columns.front().plan))
      throw InputError("--levels: required, because the default levels differ between the values of --axis");
    map.columns.push_back(std::move(column));
  }
  checkNames(map, axis);
  return map;
}

std::string mapText(const MobilityMap& map) {
  const std::vector<EventRow>& first = map.columns.front().rows;
  std::size_t width = 10;
  for (const MapColumn& column : map.columns) {
    width = std::max(width, column.value.size() + 2);
    for (const EventRow& row : column.rows) width = std::max(width, goText(row).size() + 2);
  }
  const auto cell = [width](const std::string& word) { return fmt::format("{:>{}}", word, width); };
  std::string text =
      fmt::format("{}: {} over {}\n{}", base::wordOf(map.event), levelText(map.event), map.key, cell(""));
  for (const MapColumn& column : map.columns) text += cell(column.value);
  for (std::size_t i = first.size(); i-- > 0;) {
    text += "\n" + cell(fmt::format("{:g}", first[i].level));
    for (const MapColumn& column : map.columns) text += cell(goText(column.rows[i]));
  }
  text += "\n\n";
  for (const MapColumn& column : map.columns)
    for (const EventLimit& limit : eventLimits(column.rows, column.plan.course))
      text += fmt::format("{} = {:<10} {:<26}{}\n", map.key, column.value, limitText(limit), referenceText(limit));
  return text;
}

void mapCommand(const MapCommand& command) {
  const EventsCommand& events = command.events;
  const fs::path folder = folderOf(events, "map");
  const jobs::Recipe call = recipeOf(events, folder, command.axis);
  checkFolder(events, folder, call);
  MobilityMap map = planMap(optionsOfRuns(events), command.axis);
  const sweeps::SweepPlan all = runsOf(map);
  const EventPlan& first = map.columns.front().plan;
  printHead(events, "map", first, all.runs.size());
  if (events.plan) {
    fmt::print("{}", timesText(timesOf(map, folder)));
    return;
  }
  sweeps::printNotesOf(all);
  const auto outcomes = doRuns(events, "map", all, folder, call);
  if (outcomes.empty()) return;
  judgeColumns(map, outcomes, folder);
  const std::string text = mapText(map);
  fmt::print("\n{}\n", text);
  nlohmann::ordered_json json = headJson(events, first);
  json.update(mapJson(map));
  json["notices"] = sweeps::noticesJson(sweeps::runNotices(all, folder));
  support::replaceTextFile(folder / kMapTable, mapCsv(map));
  support::replaceTextFile(folder / kMapText, text);
  support::replaceTextFile(folder / kMapJson, support::jsonText(json, 2) + "\n");
  for (const char* name : {kMapTable, kMapText, kMapJson}) fmt::print("table     {}\n", (folder / name).string());
  output::drawPicture("map.py", {folder / kMapJson}, folder / kMapPlot);
  std::vector<EventRow> rows;
  for (const MapColumn& column : map.columns) rows.insert(rows.end(), column.rows.begin(), column.rows.end());
  throwOnUnknownFailures(rows, folder / kMapTable);
}

} // namespace grouser::events

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/other_events.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "runs/campaigns/sweeps/compare_results.hpp"
#include "runs/support/csv_cell.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace grouser::events {

namespace fs = std::filesystem;

namespace {

constexpr const char* kInconclusive = "inconclusive";

/// Parses events.json. Throws nlohmann::json::exception for an unexpected format.
EventSet parsed(const nlohmann::json& json) {
  EventSet set;
  set.vehicle = json.at("vehicle"), set.soil = json.at("soil"), set.ground = json.at("ground");
  set.speed = json.at("speed_m_s");
  set.drawn = json.at("draws") > 0;
  for (const auto& row : json.at("rows")) {
    const auto event = base::valueOf<Event>(row.at("event").get<std::string>());
    if (!event) continue;
    for (const auto& f : row.at("figures"))
      set.figures.push_back({*event, row.at("level").is_null() ? 0 : row.at("level").get<double>(), f.at("name"),
                             f.at("values").get<std::vector<double>>(), static_cast<int>(row.at("each").size()),
                             !f.at("doubt").get<std::string>().empty()});
  }
  return set;
}

/// Mean with its confidence interval, or with the prediction interval of one more draw.
support::Estimate estimateOf(const EventSet& set, const LevelFigure& figure) {
  if (set.drawn) return jobs::predictionInterval(figure.values, 0.05);
  return set.seeded() ? jobs::interval95(figure.values) : support::Estimate{figure.values.front(), 0};
}

std::string countText(const LevelFigure& figure) {
  return static_cast<int>(figure.values.size()) == figure.planned
             ? fmt::format("{}", figure.planned)
             : fmt::format("{} of {}", figure.values.size(), figure.planned);
}

std::string nameOf(const EventSet& set) { return fmt::format("{} on {} ({})", set.vehicle, set.soil, set.ground); }

} // namespace

bool EventSet::seeded() const { return ground == base::wordOf(scene::TerrainKind::granular); }

EventSet eventSet(const fs::path& folder, const std::string& vehicle, const EventPlan& plan,
                  const std::vector<EventRow>& rows) {
  EventSet set{folder,
               vehicle,
               plan.course.rigid() ? "rigid" : plan.course.soil,
               std::string(base::wordOf(plan.course.ground)),
               plan.course.speed,
               plan.draws > 0,
               {}};
  for (const EventRow& row : rows)
    for (const FigureOverSeeds& f : row.figures)
      set.figures.push_back({row.event, row.level, f.name, f.values, static_cast<int>(row.each.size()),
                             !row.doubtOfMean(f.name).empty()});
  return set;
}

EventSet readEventSet(const fs::path& folder) {
  const fs::path file = folder / "events.json";
  std::error_code error;
  if (fs::symlink_status(file, error).type() == fs::file_type::not_found)
    throw base::InputError(fmt::format(
        "--against {}: contains no events.json; specify the results folder of `grouser events`", folder.string()));
  const std::string text = base::readInput(file, "specify the results folder of `grouser events` with --against");
  try {
    EventSet set = parsed(nlohmann::json::parse(text));
    set.folder = folder;
    return set;
  } catch (const nlohmann::json::exception& fault) {
    throw base::InputError(fmt::format(
        "--against {}: {} is damaged or was written by another version ({}); repeat the command that wrote it",
        folder.string(), file.string(), fault.what()));
  }
}

std::vector<FigureDifference> differencesFrom(const EventSet& here, const EventSet& other, double percent) {
  std::vector<FigureDifference> all;
  for (const LevelFigure& mine : here.figures) {
    const auto found = std::find_if(other.figures.begin(), other.figures.end(), [&mine](const LevelFigure& f) {
      return f.event == mine.event && std::fabs(f.level - mine.level) < 1e-9 && f.name == mine.name;
    });
    if (found == other.figures.end() || mine.values.empty() || found->values.empty()) continue;
    FigureDifference d{mine, *found, estimateOf(here, mine), estimateOf(other, *found), {}, {}};
    const support::Estimate &a = d.ofOther, &b = d.ofHere;
    d.difference = here.seeded() && other.seeded()
                       ? jobs::unpairedChange(found->values, mine.values)
                       : support::Estimate{b.value - a.value, std::hypot(a.halfWidth, b.halfWidth)};
    d.verdict = mine.doubtful || found->doubtful ? kInconclusive
                                                 : sweeps::variantVerdict(d.difference, a.value, b.value, percent);
    all.push_back(std::move(d));
  }
  return all;
}

std::string differencesText(const std::vector<FigureDifference>& differences, const EventSet& here,
                            const EventSet& other, double percent) {
  std::string text = fmt::format("{}\ncompared with {}: {}; equal means within {:g} % of the larger mean\n",
                                 nameOf(here), other.folder.string(), nameOf(other), percent);
  for (const auto& [what, a, b] :
       {std::tuple{"vehicle", here.vehicle, other.vehicle},
        {"soil", here.soil, other.soil},
        {"commanded speed [m/s]", fmt::format("{:g}", here.speed), fmt::format("{:g}", other.speed)}})
    if (a != b) text += fmt::format("WARNING: different {}: {} and {}\n", what, a, b);
  if (differences.empty()) return text + "no common event, level and figure\n";
  text += fmt::format("{:<18}{:<7}{:<46}{:>22}{:>5}{:>22}{:>8}{:>22}\n", "event", "level", "figure", here.ground,
                      "runs", other.ground, "runs", "difference");
  for (const FigureDifference& d : differences)
    text +=
        fmt::format("{:<18}{:<7}{:<46}{:>22}{:>5}{:>22}{:>8}{:>22}  {}\n", base::wordOf(d.here.event),
                    levelCell(d.here.event, d.here.level), d.here.name, sweeps::figureText(d.ofHere), countText(d.here),
                    sweeps::figureText(d.ofOther), countText(d.other), sweeps::figureText(d.difference), d.verdict);
  return text;
}

std::string differencesCsv(const std::vector<FigureDifference>& differences, const EventSet& other, bool head) {
  std::string text = head ? "other folder,other vehicle,other soil,other ground,event,level,figure,mean,half width,"
                            "runs,other mean,other half width,other runs,difference,half width of the difference,"
                            "verdict\n"
                          : "";
  for (const FigureDifference& d : differences) {
    text += fmt::format("{},{},{},{},{},{},{}", support::csvCell(other.folder.string()),
                        support::csvCell(other.vehicle), other.soil, other.ground, base::wordOf(d.here.event),
                        levelCell(d.here.event, d.here.level), support::csvCell(d.here.name));
    for (const auto& [e, f] : {std::pair{&d.ofHere, &d.here}, {&d.ofOther, &d.other}})
      text += fmt::format(",{},{},{}", support::csvCell(e->value), support::csvCell(e->halfWidth), f->values.size());
    text += fmt::format(",{},{},{}\n", support::csvCell(d.difference.value), support::csvCell(d.difference.halfWidth),
                        d.verdict);
  }
  return text;
}

} // namespace grouser::events

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/other_events.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/compare_results.hpp"
#include "runs/support/csv_cell.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace grouser::events {

namespace fs = std::filesystem;

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string levelCell(const LevelFigure& figure) {
  return levelText(figure.event).empty() ? "" : fmt::format("{:g}", figure.level);
}

std::string cell(const support::Estimate& e) {
  return e.halfWidth == 0 || !std::isfinite(e.halfWidth) ? fmt::format("{:.4g}", e.value) : jobs::valueText(e);
}

/// The figures of a file of results. Throws nlohmann::json::exception where it has another form.
OtherEvents parsed(const nlohmann::json& json) {
  OtherEvents other;
  const bool random = json.at("ground") == base::wordOf(scene::TerrainKind::granular) || json.value("draws", 0) > 0;
  other.vehicle = json.at("vehicle");
  other.ground = fmt::format("{} ({})", json.at("soil").get<std::string>(), json.at("ground").get<std::string>());
  for (const auto& row : json.at("rows")) {
    const auto event = base::valueOf<Event>(row.at("event").get<std::string>());
    if (!event) continue;
    const double level = row.at("level").is_null() ? 0 : row.at("level").get<double>();
    for (const auto& f : row.at("figures"))
      other.figures.push_back({*event,
                               level,
                               f.at("name"),
                               {f.at("mean"), !random                        ? 0
                                              : f.at("half_width").is_null() ? kInfinite
                                                                             : f.at("half_width").get<double>()}});
  }
  return other;
}

} // namespace

OtherEvents readOtherEvents(const fs::path& folder) {
  const fs::path file = folder / "events.json";
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw base::InputError(fmt::format("--against {}: holds no events.json; name the folder of a `grouser events` that "
                                       "has ended",
                                       folder.string()));
  try {
    std::ifstream in(file);
    OtherEvents other = parsed(nlohmann::json::parse(in));
    other.folder = folder;
    return other;
  } catch (const nlohmann::json::exception& fault) {
    throw base::InputError(fmt::format("--against {}: {} is damaged ({}); run these events again", folder.string(),
                                       file.string(), fault.what()));
  }
}

std::vector<LevelFigure> figuresOf(const std::vector<EventRow>& rows, bool random) {
  std::vector<LevelFigure> all;
  for (const EventRow& row : rows)
    for (const FigureOverSeeds& f : row.figures)
      all.push_back({row.event, row.level, f.name, {f.estimate.value, random ? f.estimate.halfWidth : 0}});
  return all;
}

std::vector<FigureBeside> besides(const std::vector<LevelFigure>& here, const OtherEvents& other, double percent) {
  std::vector<FigureBeside> all;
  for (const LevelFigure& mine : here) {
    const auto found = std::find_if(other.figures.begin(), other.figures.end(), [&mine](const LevelFigure& f) {
      return f.event == mine.event && std::fabs(f.level - mine.level) < 1e-9 && f.name == mine.name;
    });
    if (found == other.figures.end()) continue;
    const support::Estimate &a = found->estimate, &b = mine.estimate;
    const support::Estimate difference{b.value - a.value, std::hypot(a.halfWidth, b.halfWidth)};
    all.push_back({mine, *found, difference, sweeps::groundVerdict(difference, a.value, b.value, percent)});
  }
  return all;
}

std::string besidesText(const std::vector<FigureBeside>& figures, const std::string& here, const OtherEvents& other,
                        double percent) {
  std::string text = fmt::format("beside {}: {} on {}; equal: within {:g} % of the larger mean\n",
                                 other.folder.string(), other.vehicle, other.ground, percent);
  if (figures.empty()) return text + "no event, level and figure in common\n";
  text += fmt::format("{:<18}{:<7}{:<46}{:>22}{:>22}{:>22}\n", "event", "level", "figure", here, "other", "difference");
  for (const FigureBeside& f : figures)
    text += fmt::format("{:<18}{:<7}{:<46}{:>22}{:>22}{:>22}  {}\n", base::wordOf(f.here.event), levelCell(f.here),
                        f.here.name, cell(f.here.estimate), cell(f.other.estimate), cell(f.difference), f.verdict);
  return text;
}

std::string besidesCsv(const std::vector<FigureBeside>& figures, const OtherEvents& other, bool head) {
  std::string text = head ? "other folder,other ground,event,level,figure,mean,half width,other mean,other half width,"
                            "difference,half width of the difference,verdict\n"
                          : "";
  for (const FigureBeside& f : figures) {
    text += fmt::format("{},{},{},{},{}", support::csvCell(other.folder.string()), support::csvCell(other.ground),
                        base::wordOf(f.here.event), levelCell(f.here), support::csvCell(f.here.name));
    for (const support::Estimate& e : {f.here.estimate, f.other.estimate, f.difference})
      text += fmt::format(",{},{}", support::csvCell(e.value), support::csvCell(e.halfWidth));
    text += "," + f.verdict + "\n";
  }
  return text;
}

} // namespace grouser::events

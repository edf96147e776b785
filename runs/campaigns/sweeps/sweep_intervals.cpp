// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/sweep_intervals.hpp"

#include "base/math.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/jobs/estimate.hpp"
#include "runs/support/csv_cell.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace grouser::sweeps {

namespace {

/// Main figures of a vehicle; for surfaces, the forces are the main figures.
constexpr const char* kShown[] = {"sinkage mean [m]", "sinkage max [m]",    "slip [-]",
                                  "speed [m/s]",      "drive torque [N m]", "tension mean [N]"};

bool isShown(const SeedIntervals& intervals, const std::string& column) {
  if (intervals.hitched && (column == "drawbar pull [N]" || column == "motion resistance [N]")) return true;
  return std::find(std::begin(kShown), std::end(kShown), column) != std::end(kShown) ||
         column.find(" force ") != std::string::npos;
}

/// Finite values of one figure in the runs `rows`.
std::vector<double> valuesOf(const SweepFigures& figures, const std::vector<std::size_t>& rows, std::size_t column) {
  std::vector<double> values;
  for (const std::size_t row : rows)
    if (std::isfinite(figures.values[row][column])) values.push_back(figures.values[row][column]);
  return values;
}

/// Runs of a group, in order and by seed.
struct Members {
  std::vector<std::size_t> rows;
  std::map<std::string, std::size_t> rowOf;
};

/// Runs of a and b with the same seed.
std::vector<std::pair<std::size_t, std::size_t>> pairsOf(const Members& a, const Members& b) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [seed, row] : a.rowOf)
    if (const auto same = b.rowOf.find(seed); same != b.rowOf.end()) pairs.emplace_back(row, same->second);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Adds to `of` the differences between the second and the first run of each pair.
void addDifference(const SweepFigures& figures, const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                   std::size_t column, SeedGroup& of) {
  std::vector<double> first, second;
  for (const auto& [a, b] : pairs) {
    const double x = figures.values[a][column], y = figures.values[b][column];
    if (std::isfinite(x) && std::isfinite(y)) first.push_back(x), second.push_back(y);
  }
  const support::Estimate none{base::kNaN, base::kNaN};
  of.differences.push_back(first.empty() ? none : jobs::pairedDifference(first, second));
  of.changes.push_back(first.empty() ? none : jobs::pairedChange(first, second));
}

std::string named(const SeedIntervals& intervals, const SeedGroup& group) {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < intervals.keys.size(); ++k)
    words.push_back(intervals.keys[k] == kCaseKey ? group.values[k]
                                                  : fmt::format("{}={}", intervals.keys[k], group.values[k]));
  return words.empty() ? "all" : fmt::format("{}", fmt::join(words, ", "));
}

/// Reason why a figure of a group is inconclusive; empty if valid or missing.
std::string doubtOf(const SeedGroup& group, std::size_t column) {
  const support::Estimate& figure = group.figures[column];
  if (!std::isfinite(figure.value)) return {};
  return !group.doubt.empty() ? group.doubt : jobs::isInconclusive(figure) ? "interval wider than the value" : "";
}

/// "+12.3 +- 0.4 %"; in the figure's unit if the first mean does not differ significantly from zero.
std::string differenceText(const support::Estimate& first, const SeedGroup& group, std::size_t column) {
  const support::Estimate &share = group.differences[column], &change = group.changes[column];
  const bool zero = !(std::fabs(first.value) > first.halfWidth) && std::isfinite(first.halfWidth);
  const double value = zero ? change.value : share.value;
  return fmt::format("{}{}", value < 0 ? "" : "+", zero ? jobs::valueText(change) : jobs::percent(share));
}

} // namespace

SeedIntervals seedIntervals(const SweepPlan& plan, const SweepFigures& given) {
  SeedIntervals all;
  all.columns = given.columns;
  all.hitched = std::any_of(plan.runs.begin(), plan.runs.end(), [](const SweepRun& run) { return run.scene.hitch; });
  const auto seed = std::find(plan.keys.begin(), plan.keys.end(), kSeedKey);
  if (seed == plan.keys.end()) return all;
  const std::ptrdiff_t at = seed - plan.keys.begin();
  all.keys = plan.keys;
  all.keys.erase(all.keys.begin() + at);
  std::vector<Members> members;
  std::map<std::vector<std::string>, std::size_t> groupOf;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    std::vector<std::string> values = plan.runs[i].values;
    const std::string seedOfRun = values[static_cast<std::size_t>(at)];
    values.erase(values.begin() + at);
    const auto [group, isNew] = groupOf.try_emplace(values, all.groups.size());
    if (isNew) all.groups.push_back({values, 0, "", {}, {}, {}}), members.emplace_back();
    Members& m = members[group->second];
    m.rows.push_back(i), m.rowOf.try_emplace(seedOfRun, i);
  }
  SweepFigures figures = given;
  for (std::size_t g = 0; g < members.size(); ++g)
    all.groups[g].doubt = figures.doubtOf(members[g].rows), figures.dropInconclusive(members[g].rows);
  for (std::size_t g = 0; g < members.size(); ++g) {
    const std::vector<std::pair<std::size_t, std::size_t>> pairs = pairsOf(members[0], members[g]);
    for (std::size_t c = 0; c < all.columns.size(); ++c) {
      const std::vector<double> values = valuesOf(figures, members[g].rows, c);
      SeedGroup& group = all.groups[g];
      group.runs = std::max(group.runs, static_cast<int>(values.size()));
      group.figures.push_back(values.empty() ? support::Estimate{base::kNaN, base::kNaN} : jobs::interval95(values));
      addDifference(figures, pairs, c, group);
    }
  }
  return all;
}

std::filesystem::path writeIntervals(const SeedIntervals& intervals, const std::filesystem::path& folder) {
  std::string text;
  for (const std::string& key : intervals.keys) text += support::csvCell(key) + ",";
  text += "figure,seeds,mean,half width,difference to the first [-],half width of the difference [-],"
          "difference to the first,half width of the difference,inconclusive\n";
  for (const SeedGroup& group : intervals.groups)
    for (std::size_t c = 0; c < intervals.columns.size(); ++c) {
      for (const std::string& value : group.values) text += support::csvCell(value) + ",";
      text += fmt::format("{},{}", support::csvCell(intervals.columns[c]), group.runs);
      for (const support::Estimate& e : {group.figures[c], group.differences[c], group.changes[c]})
        text += fmt::format(",{},{}", support::csvCell(e.value), support::csvCell(e.halfWidth));
      text += fmt::format(",{}\n", support::csvCell(doubtOf(group, c)));
    }
  std::filesystem::path path = folder / kIntervalsFile;
  support::replaceTextFile(path, text);
  return path;
}

std::string intervalsText(const SeedIntervals& intervals) {
  std::size_t width = 8;
  for (const SeedGroup& group : intervals.groups) width = std::max(width, named(intervals, group).size());
  std::string text =
      fmt::format("\nmeans over the steady part; +- is the half width of the 95 % interval over seeds{}\n",
                  intervals.groups.size() > 1 ? "; differences from the first line, paired by seed" : "");
  for (std::size_t c = 0; c < intervals.columns.size(); ++c) {
    const bool isKnown = std::any_of(intervals.groups.begin(), intervals.groups.end(),
                                     [c](const SeedGroup& g) { return std::isfinite(g.figures[c].value); });
    if (!isShown(intervals, intervals.columns[c]) || !isKnown) continue;
    text += intervals.columns[c] + "\n";
    for (const SeedGroup& group : intervals.groups) {
      if (!std::isfinite(group.figures[c].value)) continue;
      text += fmt::format("  {:<{}}  {:>22}  {} seed{}{}", named(intervals, group), width,
                          jobs::valueText(group.figures[c]), group.runs, group.runs == 1 ? " " : "s",
                          doubtOf(group, c).empty() ? "" : "  inconclusive");
      if (&group != &intervals.groups.front() && std::isfinite(group.differences[c].value))
        text += fmt::format("  {:>18}", differenceText(intervals.groups.front().figures[c], group, c));
      text += "\n";
    }
  }
  return text;
}

} // namespace grouser::sweeps

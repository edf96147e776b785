// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_series.hpp"

#include "base/math.hpp"
#include "runs/support/csv_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace grouser::sweeps {

namespace {

/// Series and seed of a run.
struct Member {
  int refinement; ///< refinement of the step
  std::int64_t seed;
  const RunSeries* series;
};

/// Finished runs of the base and of finer steps.
std::vector<Member> membersOf(const CheckCases& cases, const CheckRuns& runs,
                              const std::vector<SweepOutcome>& outcomes) {
  std::vector<Member> members;
  for (std::size_t r = 0; r < runs.caseOf.size(); ++r) {
    const CheckCase& c = cases.cases[runs.caseOf[r]];
    if (hasPartInSeries(c) && output::hasEnded(outcomes[r].status))
      members.push_back({c.refinement, runs.seedOf[r], &runs.series[r]});
  }
  return members;
}

bool sameTimes(const RunSeries& a, const RunSeries& b) {
  if (a.time.size() != b.time.size()) return false;
  for (std::size_t i = 0; i < a.time.size(); ++i)
    if (std::fabs(a.time[i] - b.time[i]) > 1e-9 * std::fabs(a.time.back())) return false;
  return true;
}

/// Mean and half width; for reproducible runs, the single value.
support::Estimate estimateOf(const std::vector<double>& values, bool seeded, double miss) {
  if (values.empty()) return {base::kNaN, base::kNaN};
  return seeded ? jobs::interval(values, miss) : support::Estimate{values.front(), 0};
}

/// Values of one column in one row, by refinement and seed.
using Cell = std::map<int, std::map<std::int64_t, double>>;

double stepBar(const Cell& cell, bool seeded, double miss) {
  const auto base = cell.find(0);
  if (base == cell.end()) return base::kNaN;
  if (!seeded) {
    std::vector<double> values;
    for (int refinement = 0; cell.contains(refinement); ++refinement)
      values.push_back(cell.at(refinement).begin()->second);
    return values.size() < 2 ? base::kNaN : stepError(values).bar;
  }
  const auto fine = cell.find(1);
  if (fine == cell.end()) return base::kNaN;
  std::vector<double> changes;
  for (const auto& [seed, value] : base->second)
    if (const auto other = fine->second.find(seed); other != fine->second.end())
      changes.push_back(other->second - value);
  return changes.empty() ? base::kNaN : scatteredStepError(changes, {}, miss).bar;
}

/// One column, from the members that have this column.
struct Column {
  std::vector<const Member*> members;
  std::vector<const std::vector<double>*> values; ///< all rows, one column per member

  Column(const std::vector<Member>& all, const std::string& name) {
    for (const Member& m : all)
      if (const std::vector<double>* found = m.series->of(name)) members.push_back(&m), values.push_back(found);
  }
  Cell at(std::size_t row) const {
    Cell cell;
    for (std::size_t k = 0; k < members.size(); ++k)
      if (const double value = (*values[k])[row]; std::isfinite(value))
        cell[members[k]->refinement][members[k]->seed] = value;
    return cell;
  }
};

} // namespace

bool hasPartInSeries(const CheckCase& aCase) {
  return aCase.axis == CheckAxis::base || (aCase.axis == CheckAxis::step && aCase.refinement > 0);
}

CheckSeries checkSeries(const CheckCases& cases, const CheckRuns& runs, const std::vector<SweepOutcome>& outcomes,
                        const SeedLevels& levels) {
  std::vector<Member> members = membersOf(cases, runs, outcomes);
  CheckSeries all;
  const auto base = std::find_if(members.begin(), members.end(), [](const Member& m) { return m.refinement == 0; });
  if (base == members.end()) return all;
  const RunSeries& first = *base->series;
  std::erase_if(members, [&](const Member& m) { return !sameTimes(*m.series, first); });
  all.time = first.time;
  for (const std::string& column : first.columns) {
    if (column.starts_with("terrain.rebuilds")) continue; // depends on the neighbour search
    SeriesWithBars& s = all.series.emplace_back();
    s.name = column;
    const Column ofColumn(members, column);
    for (std::size_t row = 0; row < all.time.size(); ++row) {
      const Cell cell = ofColumn.at(row);
      std::vector<double> values;
      if (const auto at = cell.find(0); at != cell.end())
        for (const auto& [seed, value] : at->second) values.push_back(value);
      const support::Estimate e = estimateOf(values, cases.seeded, levels.value);
      s.value.push_back(e.value), s.seeds.push_back(e.halfWidth),
          s.step.push_back(stepBar(cell, cases.seeded, levels.change));
      s.both.push_back(std::hypot(s.seeds.back(), s.step.back()));
    }
  }
  return all;
}

std::string seriesCsv(const CheckSeries& series) {
  std::string text = "time [s]";
  for (const SeriesWithBars& s : series.series)
    for (const char* what : {"", " seeds +-", " step +-", " both +-"})
      text += fmt::format(",{}", support::csvCell(s.name + what));
  text += "\n";
  for (std::size_t row = 0; row < series.time.size(); ++row) {
    text += support::csvCell(series.time[row]);
    for (const SeriesWithBars& s : series.series)
      for (const double value : {s.value[row], s.seeds[row], s.step[row], s.both[row]})
        text += fmt::format(",{}", support::csvCell(value));
    text += "\n";
  }
  return text;
}

} // namespace grouser::sweeps

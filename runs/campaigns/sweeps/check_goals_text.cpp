// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_goals_text.hpp"

#include "base/counted.hpp"
#include "runs/support/progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace grouser::sweeps {

namespace {

using Json = nlohmann::ordered_json;

const char* wordOf(GoalState state) {
  switch (state) {
  case GoalState::met:
    return "met";
  case GoalState::open:
    return "not met";
  case GoalState::beyond:
    return "not met: requires more than --seeds";
  case GoalState::limited:
    return "not met: limited by axes";
  default:
    return "unknown";
  }
}

std::string nameOf(const BarPart& part) {
  return part.axis == CheckAxis::base ? "seeds" : std::string(base::wordOf(part.axis));
}

/// Cases that contribute to the bars of goals but lack runs: "floor (failed)".
std::vector<std::string> missingCases(const CheckRecord& record) {
  std::vector<std::string> missing;
  for (std::size_t c = 0; c < record.cases.cases.size(); ++c) {
    const CaseStatus status = statusOf(record, c);
    if (status.word == "finished" || !status.isNeeded || !hasPart(record.cases, c)) continue;
    const std::string name = c == 0 ? "base" : record.cases.cases[c].name;
    missing.push_back(fmt::format("{} ({})", name, status.word == "left out" ? status.message : status.word));
  }
  return missing;
}

/// A goal does not count as met while cases that contribute to its bar lack runs.
const char* stateOf(const CheckRecord& record, const Goal& goal) {
  return goal.state == GoalState::met && !missingCases(record).empty() ? "inconclusive" : wordOf(goal.state);
}

/// Current number of seeds of each case.
std::vector<int> seedsSoFar(const CheckRecord& record) {
  std::vector<int> seeds(record.cases.cases.size(), 0);
  for (const std::size_t c : record.runs.caseOf) ++seeds[c];
  return seeds;
}

/// "about 36 more runs, 40 min".
std::string moreText(const CheckRecord& record, const std::vector<int>& toReach) {
  const std::vector<int> taken = seedsSoFar(record);
  int runs = 0;
  double seconds = 0;
  for (std::size_t c = 0; c < toReach.size(); ++c) {
    runs += toReach[c] - taken[c];
    if (std::isfinite(record.costs[c].wall)) seconds += record.costs[c].wall * (toReach[c] - taken[c]) / record.jobs;
  }
  if (runs == 0) return "even 1000 seeds are unlikely to suffice";
  return fmt::format("about {} more {} required ({}, up to {} seeds)", runs, runs == 1 ? "run" : "runs",
                     support::Progress::duration(seconds), *std::max_element(toReach.begin(), toReach.end()));
}

/// Remedy for an unmet bar.
std::string remedy(const CheckRecord& record, const Goal& goal, const std::vector<int>& toReach) {
  const BarPart& worst = *goal.largest();
  if (goal.state == GoalState::limited)
    return fmt::format("{} changes the value by {:+.3g} {}; more seeds cannot reduce this error; change the scene",
                       nameOf(worst), worst.change, unitOf(goal.figure));
  if (!record.isWhole) return "repeat the command to continue";
  if (!record.cases.seeded) return "requires a smaller time step than those tested";
  return moreText(record, toReach);
}

std::string lineOf(const CheckRecord& record, const Goal& goal, const std::vector<int>& toReach) {
  if (goal.state == GoalState::unknown)
    return fmt::format("  {:<24} unknown: no run has a conclusive value\n", goal.figure);
  const auto share = [&](double bar) {
    const double percent = 100 * bar / std::fabs(goal.value);
    return !std::isfinite(percent) ? "?"
           : percent >= 10         ? fmt::format("{:.0f}", percent)
                                   : fmt::format("{:.2g}", percent);
  };
  std::string text = fmt::format("  {:<24} {:>28}  {:>5} %  {}", goal.figure, jobs::valueText({goal.value, goal.bar}),
                                 share(goal.bar), stateOf(record, goal));
  const BarPart* worst = goal.largest();
  if (goal.state != GoalState::met && worst)
    text += fmt::format("; largest contribution: {} {} %; {}", nameOf(*worst), share(worst->bar),
                        remedy(record, goal, toReach));
  return text + "\n";
}

} // namespace

nlohmann::ordered_json goalsJson(const CheckRecord& record) {
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  const std::vector<std::string> missing = missingCases(record);
  Json all = Json::array();
  for (std::size_t g = 0; g < record.goals.size(); ++g) {
    const Goal& goal = record.goals[g];
    Json json{{"figure", goal.figure},          {"wanted", number(goal.wanted)},
              {"bar", number(goal.bar)},        {"met", goal.state == GoalState::met && missing.empty()},
              {"state", stateOf(record, goal)}, {"missing", missing}};
    json["parts"] = Json::array();
    for (const BarPart& part : goal.parts)
      json["parts"].push_back({{"part", nameOf(part)}, {"bar", number(part.bar)}, {"seeds", part.seeds}});
    json["seeds_to_reach"] = Json::object();
    for (std::size_t c = 0; c < record.toReach[g].size(); ++c)
      json["seeds_to_reach"][record.cases.cases[c].name] = record.toReach[g][c];
    all.push_back(json);
  }
  return all;
}

std::string goalsText(const CheckRecord& record, double percent) {
  if (record.looks.seeds.empty()) return "";
  std::string text =
      fmt::format("\nerror bars of --of (target {:g} %), {}", percent, base::counted(record.runs.caseOf.size(), "run"));
  if (record.cases.seeded)
    text += fmt::format(", intervals evaluated at {} seeds", fmt::join(record.looks.seeds, ", "));
  text += "\n";
  if (record.goals.empty()) text += "  some of the first runs have not finished; repeat the command to continue\n";
  for (std::size_t g = 0; g < record.goals.size(); ++g) text += lineOf(record, record.goals[g], record.toReach[g]);
  if (const std::vector<std::string> missing = missingCases(record); !missing.empty())
    text += fmt::format("  these bars do not include: {}\n", fmt::join(missing, ", "));
  return text;
}

} // namespace grouser::sweeps

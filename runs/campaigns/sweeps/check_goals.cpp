// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/check_goals.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace grouser::sweeps {

namespace {

constexpr double kMissed = 0.05;  // probability that any interval misses the true value
constexpr double kFarAway = 1000; // bar assumed for a part without runs [target bars]
constexpr double kCheap = 1.5;    // maximum cost of cases that are run first [base runs]

/// Half width of an interval over seeds with this standard deviation.
double halfWidth(double deviation, int seeds, double miss) {
  return support::student(seeds - 1, miss) * deviation / std::sqrt(static_cast<double>(seeds));
}

/// Total bar of all parts; `barOf`: bar of a part.
template <class BarOf> double total(const std::vector<BarPart>& parts, const BarOf& barOf) {
  std::vector<double> bars;
  for (const BarPart& part : parts) bars.push_back(barOf(part));
  return totalBar(0, bars);
}

/// Case of an axis; for the step, the case h/2.
std::size_t caseOf(const CheckCases& cases, CheckAxis axis) {
  const auto at = std::find_if(cases.cases.begin(), cases.cases.end(), [axis](const CheckCase& c) {
    return c.axis == axis && (axis != CheckAxis::step || c.refinement == 1);
  });
  return static_cast<std::size_t>(at - cases.cases.begin());
}

std::vector<BarPart> partsOf(const CheckCases& cases, const CheckFigure& figure, const SeedLevels& levels) {
  const auto part = [&](std::size_t c, CheckAxis axis, int seeds, const support::Estimate& e, double miss) {
    BarPart p;
    p.ofCase = c, p.axis = axis, p.seeds = seeds, p.miss = miss;
    p.deviation = !cases.seeded ? 0
                  : seeds < 2   ? base::kNaN
                              : e.halfWidth * std::sqrt(static_cast<double>(seeds)) / support::student(seeds - 1, miss);
    return p;
  };
  std::vector<BarPart> parts;
  if (cases.seeded) {
    parts.push_back(part(0, CheckAxis::base, figure.seeds, figure.value, levels.value));
    parts.back().bar = figure.value.halfWidth;
  }
  for (const AxisError& e : figure.errors) {
    if (cases.seeded && e.axis == CheckAxis::precision) continue;
    parts.push_back(part(caseOf(cases, e.axis), e.axis, e.seeds, e.change, levels.change));
    parts.back().change = e.change.value, parts.back().bar = e.bar;
    if (cases.seeded && e.axis == CheckAxis::step && !e.order) parts.back().factor = kStepUnseen;
    if (e.axis == CheckAxis::nodeSpacing) parts.back().factor = kStepUnseen;
  }
  return parts;
}

/// Predicted bar of a goal after the planned runs.
double expectedBar(const Goal& goal, const std::vector<int>& taken, const std::vector<int>& planned) {
  return total(goal.parts, [&](const BarPart& p) {
    const double bar = planned[p.ofCase] > taken[p.ofCase] ? p.expected(planned[p.ofCase]) : p.bar;
    return std::isfinite(bar) ? bar : kFarAway * goal.wanted;
  });
}

/// `planned` plus the next look of case c, and of the base if the paired differences require it.
std::vector<int> withMore(const std::vector<int>& planned, std::size_t c, const Looks& looks) {
  std::vector<int> more = planned;
  more[c] = looks.after(planned[c]);
  more[0] = std::max(more[0], more[c]);
  return more;
}

/// Reduction of the squared bars of open goals / cost of the runs, from `planned` to `more`.
double worth(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& taken,
             const std::vector<int>& planned, const std::vector<int>& more, const RunCosts& costs) {
  double gain = 0;
  for (const Goal& goal : goals) {
    if (goal.state != GoalState::open) continue;
    const double before = expectedBar(goal, taken, planned), after = expectedBar(goal, taken, more);
    gain += (before * before - after * after) / (goal.wanted * goal.wanted);
  }
  constexpr double kMinGain = 0.01; // relative to the square of the target bar; smaller gains do not justify a run
  return gain < kMinGain ? 0 : gain / (secondsOf(cases, costs, more) - secondsOf(cases, costs, planned));
}

/// Returns `taken` plus further looks, until the open goals are expected to be met or no look can be added.
std::vector<int> plannedSeeds(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& taken,
                              const Looks& looks, const RunCosts& costs, const SeedsFit& fits) {
  std::vector<int> planned = taken;
  const auto isFar = [&](const Goal& g) {
    return g.state == GoalState::open && expectedBar(g, taken, planned) > g.wanted;
  };
  while (std::any_of(goals.begin(), goals.end(), isFar)) {
    std::optional<std::vector<int>> best;
    double bestWorth = 0;
    for (std::size_t c = 0; c < taken.size(); ++c) {
      if (taken[c] == 0 || !hasPart(cases, c)) continue;
      std::vector<int> more = withMore(planned, c, looks);
      if (more == planned || !fits(more)) continue;
      const double of = worth(cases, goals, taken, planned, more, costs);
      if (of > bestWorth) best = std::move(more), bestWorth = of;
    }
    if (!best) break;
    planned = std::move(*best);
  }
  return planned;
}

/// The open goal with intervals at other levels.
Goal atLevels(Goal goal, const SeedLevels& levels) {
  goal.state = GoalState::open;
  for (BarPart& p : goal.parts) {
    const double miss = p.axis == CheckAxis::base ? levels.value : levels.change;
    if (p.seeds > 1)
      p.bar += p.factor * (halfWidth(p.deviation, p.seeds, miss) - halfWidth(p.deviation, p.seeds, p.miss));
    p.miss = miss;
  }
  return goal;
}

/// State of an unmet goal.
GoalState stateOf(const Goal& goal, const Looks& looks, bool seeded) {
  constexpr int kUnlimited = 1'000'000;
  const auto least = [&](int seeds) {
    return total(goal.parts, [&](const BarPart& p) { return std::max(0.0, p.least(std::max(p.seeds, seeds))); });
  };
  if (!seeded) { // more runs are possible on the step axis only
    const double others = total(goal.parts, [](const BarPart& p) { return p.axis == CheckAxis::step ? 0 : p.bar; });
    return others > goal.wanted ? GoalState::limited : GoalState::open;
  }
  if (least(kUnlimited) > goal.wanted) return GoalState::limited;
  return least(looks.most()) > goal.wanted ? GoalState::beyond : GoalState::open;
}

/// Converts to lower case, replaces '_' by a blank, removes the unit.
std::string plainName(std::string name) {
  const std::size_t from = name.find(" ["), to = name.find(']');
  if (from < to && to != std::string::npos) name.erase(from, to + 1 - from);
  for (char& c : name) c = c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

} // namespace

bool hasPart(const CheckCases& cases, std::size_t c) {
  const CheckCase& one = cases.cases[c];
  if (one.axis == CheckAxis::skin || one.refinement < 0) return false;
  return !cases.seeded || one.axis != CheckAxis::precision;
}

int Looks::after(int taken) const {
  const auto next = std::upper_bound(seeds.begin(), seeds.end(), taken);
  return next == seeds.end() ? taken : *next;
}

Looks looksUpTo(int most, bool seeded) {
  if (!seeded) return {{1}, {}};
  Looks looks;
  for (int seeds = kFewSeeds; 4 * seeds <= 3 * most; seeds *= 2) looks.seeds.push_back(seeds);
  looks.seeds.push_back(most);
  const double share = kMissed / static_cast<double>(looks.seeds.size());
  looks.levels = {share, 2 * share};
  return looks;
}

double BarPart::expected(int more) const {
  if (!std::isfinite(deviation)) return 0; // unknown: assume zero so that it is run
  const double scatter = deviation * deviation;
  const double truth = seeds > 0 ? std::max(0.0, change * change - scatter / seeds) : 0;
  const double expectedChange = axis == CheckAxis::base ? 0 : std::sqrt(truth + scatter / more);
  return factor * (expectedChange + halfWidth(deviation, more, miss));
}

double BarPart::least(int more) const {
  if (seeds < kFewSeeds) return 0; // too few seeds to end a check, e.g. after failed runs
  const double root = std::sqrt(static_cast<double>(seeds));
  const double minChange = std::max(0.0, std::fabs(change) - 2 * deviation / root);
  constexpr int kKnown = 1000; // approximately constant quantile above this number of seeds
  const double quantile = support::student(std::min(more, kKnown) - 1, miss);
  return factor * (minChange + quantile * deviation / (1 + 1.6 / root) / std::sqrt(static_cast<double>(more)));
}

const BarPart* Goal::largest() const {
  const auto at =
      std::max_element(parts.begin(), parts.end(), [](const BarPart& a, const BarPart& b) { return a.bar < b.bar; });
  return at == parts.end() ? nullptr : &*at;
}

std::string goalFigure(const std::string& word, const std::vector<std::string>& columns) {
  static const std::pair<const char*, const char*> kShort[] = {
      {"sinkage", "sinkage mean"}, {"torque", "drive torque"}, {"tension", "tension mean"}, {"power", "drive power"}};
  std::string wanted = plainName(word);
  const auto find = [&](const std::string& name) {
    return std::find_if(columns.begin(), columns.end(), [&](const std::string& c) { return plainName(c) == name; });
  };
  auto at = find(wanted);
  for (const auto& [brief, full] : kShort)
    if (at == columns.end() && wanted == brief) at = find(full);
  if (at != columns.end()) return *at;
  std::vector<std::string> known;
  for (const auto& [brief, full] : kShort)
    if (find(full) != columns.end()) known.emplace_back(brief);
  for (const std::string& column : columns) {
    known.push_back(plainName(column));
    std::replace(known.back().begin(), known.back().end(), ' ', '_');
  }
  throw base::InputError(fmt::format("--of {}: unknown figure; choose from {}", word, fmt::join(known, ", ")));
}

void keepGoalCases(CheckCases& cases, const std::vector<CheckAxis>& axes) {
  const auto isNamed = [&](CheckAxis axis) { return std::find(axes.begin(), axes.end(), axis) != axes.end(); };
  std::vector<CheckCase> kept;
  for (std::size_t c = 0; c < cases.cases.size(); ++c) {
    const CheckCase& one = cases.cases[c];
    const bool isOther = one.axis == CheckAxis::skin || one.axis == CheckAxis::precision;
    if (hasPart(cases, c) || (isOther && isNamed(one.axis)))
      kept.push_back(one);
    else if (isOther)
      cases.omitted.push_back(
          {one.axis, "has no effect on the error bars of --of; to run it anyway, add it to --axes"});
  }
  cases.cases = std::move(kept);
}

std::vector<int> firstLook(const CheckCases& cases, const Looks& looks, const SeedsFit& fits) {
  std::vector<int> seeds(cases.cases.size(), 0);
  for (std::size_t c = 0; c < seeds.size(); ++c) {
    const CheckCase& one = cases.cases[c];
    if (!one.refused.empty() || one.cost > kCheap) continue;
    std::vector<int> more = seeds;
    more[c] = one.axis == CheckAxis::skin ? 1 : looks.seeds.front();
    if (c == 0 || fits(more)) seeds = std::move(more);
  }
  return seeds;
}

bool anyReachable(const std::vector<Goal>& goals) {
  return std::any_of(goals.begin(), goals.end(),
                     [](const Goal& g) { return g.state == GoalState::met || g.state == GoalState::open; });
}

std::vector<int> secondLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& first,
                            const Looks& looks, const SeedsFit& fits) {
  std::vector<int> seeds = first;
  if (!anyReachable(goals)) return seeds;
  for (std::size_t c = 1; c < seeds.size(); ++c) {
    const CheckCase& one = cases.cases[c];
    if (!one.refused.empty() || one.cost <= kCheap) continue;
    std::vector<int> more = seeds;
    more[c] = looks.seeds.front();
    if (fits(more)) seeds = std::move(more);
  }
  return seeds;
}

std::vector<Goal> goalsOf(const CheckCases& cases, const CheckResults& results, const std::vector<std::string>& figures,
                          const Looks& looks) {
  std::vector<Goal> goals;
  for (const std::string& name : figures) {
    Goal& goal = goals.emplace_back();
    goal.figure = name;
    const auto figure = std::find_if(results.figures.begin(), results.figures.end(),
                                     [&](const CheckFigure& f) { return f.name == name; });
    if (figure == results.figures.end() || !results.doubt.empty()) continue;
    goal.value = figure->value.value, goal.bar = figure->bar;
    goal.wanted = 0.01 * results.percent * std::fabs(goal.value);
    goal.parts = partsOf(cases, *figure, looks.levels);
    goal.state = goal.bar <= goal.wanted ? GoalState::met : stateOf(goal, looks, cases.seeded);
  }
  return goals;
}

std::vector<int> nextLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& taken,
                          const Looks& looks, const RunCosts& costs, const SeedsFit& fits) {
  const auto isOpen = [](const Goal& g) { return g.state == GoalState::open; };
  if (!cases.seeded || std::none_of(goals.begin(), goals.end(), isOpen)) return taken;
  const std::vector<int> way = plannedSeeds(cases, goals, taken, looks, costs, fits);
  std::vector<int> next = taken;
  for (std::size_t c = 0; c < next.size(); ++c)
    if (way[c] > taken[c]) next[c] = looks.after(taken[c]);
  return next;
}

std::vector<int> seedsToReach(const CheckCases& cases, const Goal& goal, const std::vector<int>& taken,
                              const Looks& looks) {
  constexpr int kMax = 1000;
  if (!cases.seeded) return {};
  RunCosts costs;
  costs.run = 1;
  const SeedsFit any = [](const std::vector<int>&) { return true; };
  for (int most = looks.most();; most = std::min(kMax, 2 * most)) {
    const Looks more = most == looks.most() ? looks : looksUpTo(most, true);
    const Goal asked = atLevels(goal, more.levels);
    std::vector<int> planned = plannedSeeds(cases, {asked}, taken, more, costs, any);
    if (expectedBar(asked, taken, planned) <= asked.wanted) return planned;
    if (most >= kMax) return {};
  }
}

} // namespace grouser::sweeps

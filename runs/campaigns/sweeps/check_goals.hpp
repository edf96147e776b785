// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_choice.hpp"
#include "runs/campaigns/sweeps/check_results.hpp"

#include <functional>
#include <string>
#include <vector>

/// Target error bars of figures (`--of`), and the runs that reach them at the least cost.
namespace grouser::sweeps {

/// Numbers of seeds at which a check evaluates its intervals (interim looks), and their levels.
///
/// A check that stopped where a 95 % interval first becomes narrow would stop at intervals that are narrow by chance,
/// and miss more often than 5 %. So intervals are evaluated at a few numbers of seeds, fixed in advance, each with
/// an equal share of the 5 %: the probability that any of them misses is then at most 5 %, whenever the check continues
/// or stops (repeated confidence intervals: C. Jennison and B. W. Turnbull, J. R. Statist. Soc. B 51 (1989) 305;
/// shares by Bonferroni's bound). The bar |change| + half width of an axis can miss on one side only, so its share is
/// twice as large.
struct Looks {
  std::vector<int> seeds; ///< rising
  SeedLevels levels;      ///< levels at each look

  /// First number above `taken`; `taken` if none.
  int after(int taken) const;
  int most() const { return seeds.back(); }
};
/// At 3, 6, 12, 24... seeds, and at `most` [2, 1000], which replaces a look at more than three quarters of it; at 1
/// without seed dependence.
Looks looksUpTo(int most, bool seeded);

/// Contribution to a figure's bar: scatter of the base over seeds (case 0), or difference of a case from the base.
struct BarPart {
  std::size_t ofCase = 0;
  CheckAxis axis = CheckAxis::base;
  int seeds = 0;        ///< number of seeds
  double change = 0;    ///< 0 for the scatter of seeds
  double deviation = 0; ///< standard deviation of a seed's value or change; NaN for fewer than two seeds
  double factor = 1;    ///< bar = factor (|change| + half width)
  double bar = 0;       ///< in the unit of the figure
  double miss = 0.05;   ///< level of its half width

  /// Expected bar with `seeds` seeds. The change over few seeds includes scatter, which more seeds reduce.
  double expected(int seeds) const;
  /// Likely minimum: the change two standard errors closer to zero, the deviation at the low end of its interval, about
  /// 1 / (1 + 1.6 / sqrt(seeds)); 0 for fewer than three seeds.
  double least(int seeds) const;
};

enum class GoalState {
  met,     ///< the bar is at most the target
  open,    ///< more runs may reach it
  beyond,  ///< unlikely with the maximum number of seeds
  limited, ///< the axes change the figure by more than the target
  unknown  ///< no run has the figure
};

/// One figure of --of.
struct Goal {
  std::string figure; ///< "sinkage mean [m]"
  double value = 0, bar = 0;
  double wanted = 0; ///< target bar
  GoalState state = GoalState::unknown;
  std::vector<BarPart> parts; ///< the seeds first

  const BarPart* largest() const;
};

/// Column such as "sinkage mean [m]" by a word of --of: "sinkage mean", "sinkage_mean", or the short forms "sinkage",
/// "torque", "tension". Throws InputError that lists the words.
std::string goalFigure(const std::string& word, const std::vector<std::string>& columns);

/// Whether the runs of a case contribute to the bars of goals.
bool hasPart(const CheckCases& cases, std::size_t c);

/// Keeps the cases that contribute to the bars of goals, and the cases of the `axes` that the user named.
void keepGoalCases(CheckCases& cases, const std::vector<CheckAxis>& axes);

using SeedsFit = std::function<bool(const std::vector<int>&)>; ///< whether these seeds of each case fit the limits

/// [cases] seeds of the first look: the base, and cases of at most one and a half times its cost, in order while they
/// fit.
std::vector<int> firstLook(const CheckCases& cases, const Looks& looks, const SeedsFit& fits);
/// Whether a goal is met or reachable with more runs.
bool anyReachable(const std::vector<Goal>& goals);
/// The same for all cases, unless the first look shows that no goal can be reached. For reproducible runs it includes
/// all finer steps, as the bar of the step may be narrow by chance with fewer.
std::vector<int> secondLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& first,
                            const Looks& looks, const SeedsFit& fits);

/// States of the goals for these figures.
std::vector<Goal> goalsOf(const CheckCases& cases, const CheckResults& results, const std::vector<std::string>& figures,
                          const Looks& looks);

/// [cases] seeds of the next look: `taken` if all goals are met or unreachable. A greedy plan adds looks to the case
/// with the largest expected reduction of the bars per cost, until the expected bars meet the targets; each
/// planned case then advances by one look. The choice depends on results, costs and numbers only.
std::vector<int> nextLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& taken,
                          const Looks& looks, const RunCosts& costs, const SeedsFit& fits);

/// [cases] seeds that likely reach an open goal, or one beyond the looks, in a check with as many looks as needed, each
/// at its level there; empty: more than a thousand.
std::vector<int> seedsToReach(const CheckCases& cases, const Goal& goal, const std::vector<int>& taken,
                              const Looks& looks);

} // namespace grouser::sweeps

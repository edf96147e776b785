// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_choice.hpp"
#include "runs/campaigns/sweeps/check_results.hpp"

#include <functional>
#include <string>
#include <vector>

/// Target error bars of figures (`--of`), and the runs that reach these targets at the lowest cost.
namespace grouser::sweeps {

/// Numbers of seeds at which a check evaluates its intervals (interim looks), and the levels of the intervals.
///
/// A check that stopped as soon as a 95 % interval is narrow would prefer intervals that are narrow by chance; more
/// than 5 % of them would miss the true value. Intervals are therefore evaluated at a few numbers of seeds that are
/// fixed in advance, each with an equal share of the 5 %. The probability that any interval misses is then at most 5 %,
/// whenever the check stops (repeated confidence intervals: C. Jennison and B. W. Turnbull, J. R. Statist. Soc. B 51
/// (1989) 305; shares by Bonferroni's bound). The bar |change| + half width of an axis can miss on one side only, which
/// doubles its share.
struct Looks {
  std::vector<int> seeds; ///< ascending
  SeedLevels levels;      ///< levels at each look

  /// First number of seeds above `taken`; `taken` if there is none.
  int after(int taken) const;
  int most() const { return seeds.back(); }
};
/// Looks at 3, 6, 12, 24... seeds, and at `most` [2, 1000], which replaces a look at more than 3/4 `most`. Without seed
/// dependence: one look at 1 seed.
Looks looksUpTo(int most, bool seeded);

/// Contribution to a figure's error bar: scatter of the base over seeds (case 0), or change from the base to a case.
struct BarPart {
  std::size_t ofCase = 0;
  CheckAxis axis = CheckAxis::base;
  int seeds = 0;        ///< number of seeds
  double change = 0;    ///< 0 for the scatter of seeds
  double deviation = 0; ///< standard deviation of value or change over seeds; NaN for fewer than two seeds
  double factor = 1;    ///< bar = factor (|change| + half width)
  double bar = 0;       ///< in the unit of the figure
  double miss = 0.05;   ///< error probability of the half width

  /// Expected bar with `seeds` seeds. The change over few seeds includes scatter, which more seeds reduce.
  double expected(int seeds) const;
  /// Likely minimum: the change is two standard errors closer to zero, and the standard deviation is at the low end of
  /// its interval, about 1 / (1 + 1.6 / sqrt(seeds)) of its value. 0 for fewer than three seeds.
  double least(int seeds) const;
};

enum class GoalState {
  met,     ///< the bar is at most the target
  open,    ///< more runs may reach it
  beyond,  ///< the target is unlikely to be reached with the maximum number of seeds
  limited, ///< axes change the figure by more than the target
  unknown  ///< no run has the figure
};

/// One figure of --of.
struct Goal {
  std::string figure; ///< "sinkage mean [m]"
  double value = 0, bar = 0;
  double wanted = 0; ///< target bar
  GoalState state = GoalState::unknown;
  std::vector<BarPart> parts; ///< scatter of the seeds first

  const BarPart* largest() const;
};

/// Column such as "sinkage mean [m]" for a word of --of: "sinkage mean", "sinkage_mean", or a short form such as
/// "sinkage", "torque", "tension". Throws InputError, with a list of the words, for an unknown word.
std::string goalFigure(const std::string& word, const std::vector<std::string>& columns);

/// Whether the runs of a case contribute to the bars of goals.
bool hasPart(const CheckCases& cases, std::size_t c);

/// Keeps the cases that contribute to the bars of goals, and the cases of the `axes` selected by the user.
void keepGoalCases(CheckCases& cases, const std::vector<CheckAxis>& axes);

using SeedsFit = std::function<bool(const std::vector<int>&)>; ///< whether the limits allow these numbers of seeds

/// [cases] number of seeds at the first look: the base, and in order the cases that cost at most 1.5 times as much,
/// while they fit.
std::vector<int> firstLook(const CheckCases& cases, const Looks& looks, const SeedsFit& fits);
/// Whether any goal is met or can be reached with more runs.
bool anyReachable(const std::vector<Goal>& goals);
/// The same for all cases, unless the first look shows that no goal can be reached. For reproducible runs, includes all
/// finer steps, because the bar of the step may be narrow by chance with fewer.
std::vector<int> secondLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& first,
                            const Looks& looks, const SeedsFit& fits);

/// Goals for these figures, with their states.
std::vector<Goal> goalsOf(const CheckCases& cases, const CheckResults& results, const std::vector<std::string>& figures,
                          const Looks& looks);

/// [cases] number of seeds at the next look; `taken` if all goals are met or unreachable. A greedy plan adds looks to
/// the case with the largest expected reduction of the bars per cost, until the expected bars meet the targets; each
/// planned case then advances by one look. The choice depends only on results, costs and numbers of seeds.
std::vector<int> nextLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& taken,
                          const Looks& looks, const RunCosts& costs, const SeedsFit& fits);

/// [cases] numbers of seeds that would probably reach a goal that is not met, in a check with as many looks as
/// required and the corresponding levels; empty if more than a thousand.
std::vector<int> seedsToReach(const CheckCases& cases, const Goal& goal, const std::vector<int>& taken,
                              const Looks& looks);

} // namespace grouser::sweeps

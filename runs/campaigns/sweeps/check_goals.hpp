// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_choice.hpp"
#include "runs/campaigns/sweeps/check_results.hpp"

#include <functional>
#include <string>
#include <vector>

/// Bars that the user wants of some figures (`--of`), and the runs that reach them at the least cost.
namespace grouser::sweeps {

/// Numbers of seeds at which a check reads its intervals, and the level of each reading.
///
/// A check that stopped where a 95 % interval first becomes narrow would stop at intervals that are narrow by chance,
/// and miss more often than they say. So intervals are read at a few numbers of seeds, fixed in advance, and each
/// reading has an equal share of the 5 %: the chance that any of them misses is then at most 5 %, however the check
/// chooses to go on or to stop (repeated confidence intervals: C. Jennison and B. W. Turnbull, J. R. Statist. Soc. B 51
/// (1989) 305; shares by Bonferroni's inequality). The bar |change| + half width of an axis misses on one side alone,
/// where the true change is larger; an interval does so half as often as it misses, so its share is twice as large.
struct Looks {
  std::vector<int> seeds; ///< rising
  SeedLevels levels;      ///< at each of them

  /// The first number above `taken`; `taken` where there is none.
  int after(int taken) const;
  int most() const { return seeds.back(); }
};
/// At 3, 6, 12, 24... seeds, and at `most` [2, 1000], which replaces a look at more than three quarters of it; at 1
/// where seeds make no difference.
Looks looksUpTo(int most, bool seeded);

/// One part of a figure's bar: the scatter of the base's seeds (case 0), or the difference of a case from the base.
struct BarPart {
  std::size_t ofCase = 0;
  CheckAxis axis = CheckAxis::base;
  int seeds = 0;        ///< behind it
  double change = 0;    ///< 0 of the seeds
  double deviation = 0; ///< of one seed's value or change; NaN from fewer than two seeds
  double factor = 1;    ///< bar = factor (|change| + half width)
  double bar = 0;       ///< in the figure's unit
  double miss = 0.05;   ///< level of its half width

  /// The bar that so many seeds will likely leave. The change over few seeds holds some scatter, which more take away.
  double expected(int seeds) const;
  /// The least that is likely: the change two standard errors nearer to zero, the deviation at the low end of its own
  /// interval, about 1 / (1 + 1.6 / sqrt(seeds)); 0 from fewer than three seeds.
  double least(int seeds) const;
};

enum class GoalState {
  met,     ///< the bar is at most what is wanted
  open,    ///< more runs may bring it there
  beyond,  ///< not even the most seeds that may be run are likely to
  limited, ///< no number of seeds is: the axes themselves change the figure by more
  unknown  ///< no run has such a figure
};

/// One figure of --of.
struct Goal {
  std::string figure; ///< "sinkage mean [m]"
  double value = 0, bar = 0;
  double wanted = 0; ///< what the bar is to be at most
  GoalState state = GoalState::unknown;
  std::vector<BarPart> parts; ///< the seeds first

  const BarPart* largest() const;
};

/// Column "sinkage mean [m]" that a word of --of names: "sinkage mean", "sinkage_mean", or short for the usual ones
/// "sinkage", "torque", "tension". Throws InputError that lists the words.
std::string goalFigure(const std::string& word, const std::vector<std::string>& columns);

/// Whether the runs of a case count in the bars of goals.
bool hasPart(const CheckCases& cases, std::size_t c);

/// Keeps the cases that have a part in the bars of goals; others only where the user has named their `axes`.
void keepGoalCases(CheckCases& cases, const std::vector<CheckAxis>& axes);

using SeedsFit = std::function<bool(const std::vector<int>&)>; ///< whether so many seeds of each case may be run

/// [cases] seeds of the first look: the base, and cases of at most one and a half times its cost, in their order as
/// long as they fit.
std::vector<int> firstLook(const CheckCases& cases, const Looks& looks, const SeedsFit& fits);
/// Whether a goal is met, or may be by more runs.
bool anyReachable(const std::vector<Goal>& goals);
/// The same of all cases, unless the first look shows that no goal can be reached. Where runs repeat all finer steps
/// are among them: with fewer the bar of the step may be narrow by chance.
std::vector<int> secondLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& first,
                            const Looks& looks, const SeedsFit& fits);

/// How the figures of these names stand.
std::vector<Goal> goalsOf(const CheckCases& cases, const CheckResults& results, const std::vector<std::string>& figures,
                          const Looks& looks);

/// [cases] seeds of the next look: `taken` where all goals are met, or none of the others can be reached. A way to the
/// goals adds a look to the case whose bars are expected to fall most for its cost, then to the next, until the
/// expected bars are those wanted; each case on it goes on by one look, after which the results show a better way. The
/// choice depends on results, costs and numbers alone.
std::vector<int> nextLook(const CheckCases& cases, const std::vector<Goal>& goals, const std::vector<int>& taken,
                          const Looks& looks, const RunCosts& costs, const SeedsFit& fits);

/// [cases] seeds that likely reach an open goal, or one beyond the looks, in a check with as many more looks as that
/// takes, each at the level that it has there; empty: more than a thousand.
std::vector<int> seedsToReach(const CheckCases& cases, const Goal& goal, const std::vector<int>& taken,
                              const Looks& looks);

} // namespace grouser::sweeps

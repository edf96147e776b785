// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_report.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Comparison of two sets of events, e.g. of one soil on two kinds of ground.
namespace grouser::events {

/// Values of a figure at one level.
struct LevelFigure {
  Event event{};
  double level = 0;
  std::string name;           ///< with its unit
  std::vector<double> values; ///< one per run that has the figure
  int planned = 0;            ///< number of runs at the level
  bool doubtful = false;      ///< the vehicle drove too little for a mean
};

/// Results of a set of events.
struct EventSet {
  std::filesystem::path folder;
  std::string vehicle, soil, ground; ///< "light_tracked", "lete_sand", "granular"
  double speed = 0;                  ///< commanded speed [m/s]
  bool drawn = false;                ///< whether runs sample the soil constants
  std::vector<LevelFigure> figures;

  bool seeded() const; ///< whether runs use beds of different seeds
};

/// Results of the current call.
EventSet eventSet(const std::filesystem::path& folder, const std::string& vehicle, const EventPlan& plan,
                  const std::vector<EventRow>& rows);
/// Reads events.json of a folder. Throws base::InputError if it is missing or damaged.
EventSet readEventSet(const std::filesystem::path& folder);

/// A figure in both sets, and the difference (here minus other).
struct FigureDifference {
  LevelFigure here, other;
  support::Estimate ofHere, ofOther, difference; ///< means and half widths of 95 % intervals
  std::string verdict;                           ///< "equal", "differs", "inconclusive"
};

/// Differences in the order of `here`. Interval of a difference: Welch's interval between two sets with seeds; for
/// other sets the root sum of squares of both half widths (zero for a set with one run per level). `percent`: tolerance
/// for the verdict "equal", relative to the larger mean.
std::vector<FigureDifference> differencesFrom(const EventSet& here, const EventSet& other, double percent);

/// Table, with WARNING lines if vehicle, soil or commanded speed differ.
std::string differencesText(const std::vector<FigureDifference>& differences, const EventSet& here,
                            const EventSet& other, double percent);
/// One row per figure; `head`: include a header line.
std::string differencesCsv(const std::vector<FigureDifference>& differences, const EventSet& other, bool head);

} // namespace grouser::events

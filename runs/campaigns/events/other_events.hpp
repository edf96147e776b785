// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_report.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Differences between a set of events and another one, such as of the same soil as grains.
namespace grouser::events {

/// A figure of a level over its runs.
struct LevelFigure {
  Event event{};
  double level = 0;
  std::string name;           ///< with its unit
  std::vector<double> values; ///< of the runs that have it
  int planned = 0;            ///< runs of the level
  bool doubtful = false;      ///< its runs drive too little for a mean
};

/// A set of events.
struct EventSet {
  std::filesystem::path folder;
  std::string vehicle, soil, ground;  ///< "light_tracked", "lete_sand", "granular"
  double speed = 0;                   ///< commanded [m/s]
  bool seeded = false, drawn = false; ///< runs of a level differ by bed, by soil constants
  std::vector<LevelFigure> figures;
};

/// The set that these rows are of.
EventSet eventSet(const std::filesystem::path& folder, const std::string& vehicle, const EventPlan& plan,
                  const std::vector<EventRow>& rows);
/// Reads events.json of a folder. Throws base::InputError where there is none, or one that is damaged.
EventSet readEventSet(const std::filesystem::path& folder);

/// Difference here - other of a figure that both sets have.
struct FigureDifference {
  LevelFigure here, other;
  support::Estimate ofHere, ofOther, difference; ///< means and half widths of 95 % intervals
  std::string verdict;                           ///< "equal", "differs", "inconclusive"
};

/// In the order of `here`. The interval of a difference is Welch's between two sets with seeds. A set with one run a
/// level has no scatter. With draws, the interval is that of one further draw (root of the sum of both squares).
/// `percent`: of the larger mean, within which two figures are equal.
std::vector<FigureDifference> differencesFrom(const EventSet& here, const EventSet& other, double percent);

/// Table, with a line for each property in which the sets are not alike.
std::string differencesText(const std::vector<FigureDifference>& differences, const EventSet& here,
                            const EventSet& other, double percent);
/// A row for each figure; `head`: with the line of names.
std::string differencesCsv(const std::vector<FigureDifference>& differences, const EventSet& other, bool head);

} // namespace grouser::events

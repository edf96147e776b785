// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_figures.hpp"
#include "runs/campaigns/events/event_plan.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"
#include "runs/support/line_fit.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// The table of a set of events.
namespace grouser::events {

struct FigureOverSeeds {
  std::string name;           ///< with its unit
  std::vector<double> values; ///< one per run that has the figure
  /// Mean with the half width of its 95 % confidence interval over seeds, or of the 95 % prediction interval for one
  /// more draw; infinite for a single run.
  support::Estimate estimate;
};

/// Verdict of one run.
struct RunVerdict {
  std::string run;     ///< name of its folder
  std::string verdict; ///< "go", "no-go", "failed" (unrelated to the vehicle), "incomplete", "pending"
  std::string why;
};

/// A level of an event, over its seeds.
struct EventRow {
  Event event{};
  double level = 0;
  int runs = 0;    ///< runs with a verdict
  int gos = 0;     ///< runs with verdict go
  int unknown = 0; ///< runs that failed for reasons unrelated to the vehicle
  int pending = 0;
  int incomplete = 0; ///< runs whose vehicle never drove, or drove too little for a verdict
  std::vector<RunVerdict> each;
  std::vector<FigureOverSeeds> figures;
  std::string doubt;   ///< reason why steady-part figures are inconclusive; empty if valid
  std::string picture; ///< picture of the first run, relative to the folder; empty if missing

  /// Reason why a steady-part mean is inconclusive; empty if it is valid or is not a steady-part mean.
  std::string doubtOfMean(const std::string& figure) const;
  /// Reason why a figure is inconclusive; empty if it is valid.
  std::string doubtOf(const FigureOverSeeds& figure) const;
  /// Reason for the verdict of the first no-go run, else of the first finished run; or the mean drawbar pull.
  std::string why() const;
};

/// Bounds of the hardest level that a vehicle passes.
struct EventLimit {
  Event event{};
  std::optional<double> go;   ///< hardest level that all seeds pass, together with all easier levels
  std::optional<double> noGo; ///< easiest level that at least one seed fails
  std::optional<Reference> reference;
  /// Whether the runs agree with the reference: all levels easier than `passes` pass, all harder than `blocks` fail;
  /// empty: no reference.
  std::optional<bool> agrees;
};

std::vector<EventRow> eventRows(const EventPlan& plan, const std::vector<sweeps::SweepOutcome>& outcomes,
                                const std::filesystem::path& folder);
/// Limits of the events with more than one level.
std::vector<EventLimit> eventLimits(const std::vector<EventRow>& rows, const Course& course);

/// "go", "partly 1/3", "pending": the verdict over all seeds.
std::string goText(const EventRow& row);
/// "0.4"; empty for an event without levels.
std::string levelCell(Event event, double level);
/// "between 0.4 and 0.5"
std::string limitText(const EventLimit& limit);
/// Closed-form limit, and whether the runs agree with it; empty without a closed form.
std::string referenceText(const EventLimit& limit);

/// Note on runs in which only the track shoes have soil contact; printed at the start and in the tables.
inline constexpr const char* kShoesOnly =
    "soil contact: track shoes only, because coarse grains would jam the running gear (vehicle.soil_contact)";

/// Text of the tables of runs and of limits.
std::string eventsText(const std::vector<EventRow>& rows, const std::vector<EventLimit>& limits, const EventPlan& plan);
/// One row per level and figure, with its runs, mean and half width. `first`: name and value of a leading column.
std::string eventsCsv(const std::vector<EventRow>& rows, const std::pair<std::string, std::string>& first = {});
/// All results, with the keys that each level sets.
nlohmann::ordered_json eventsJson(const std::vector<EventRow>& rows, const std::vector<EventLimit>& limits,
                                  const EventPlan& plan);

} // namespace grouser::events

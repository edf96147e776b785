// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_runs.hpp"

#include <string>
#include <vector>

/// Go/no-go map of an event over its levels and the values of a key (`grouser map`).
namespace grouser::events {

struct MapCommand {
  EventsCommand events; ///< options.only contains the single event
  std::string axis;     ///< "key=value,value..."
};

/// One column of the map: runs with one value of the key.
struct MapColumn {
  std::string value;
  EventPlan plan; ///< the names of the runs start with key and value
  std::vector<EventRow> rows;
};

struct MobilityMap {
  std::string key;
  Event event{};
  std::vector<MapColumn> columns;
};

/// Plans the event for each value. Throws base::InputError for an event without levels, fewer than two levels or
/// values, levels that differ between values, or a key that an option sets; otherwise as planEvents().
MobilityMap planMap(const EventOptions& options, const std::string& axis);

/// Table of verdicts, hardest level first, and for each value the limit from the runs and in closed form.
std::string mapText(const MobilityMap& map);

/// Performs the missing runs, and writes map.txt, map.csv, map.json and map.png. Throws the errors of eventsCommand().
void mapCommand(const MapCommand& command);

} // namespace grouser::events

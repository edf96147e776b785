// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_runs.hpp"

#include <string>
#include <vector>

/// `grouser map`: go or no-go of an event over its level and the values of a key.
namespace grouser::events {

struct MapCommand {
  EventsCommand events; ///< of the single event in options.only
  std::string axis;     ///< "key=value,value..."
};

/// The runs of one value of the axis: a column of the map.
struct MapColumn {
  std::string value;
  EventPlan plan; ///< names of its runs begin with key and value
  std::vector<EventRow> rows;
};

struct MobilityMap {
  std::string key;
  Event event{};
  std::vector<MapColumn> columns;
};

/// Plans the event for each value. Throws base::InputError for an event without levels, for fewer than two levels or
/// values, for levels that differ between values, for keys that options set, and as planEvents() does.
MobilityMap planMap(const EventOptions& options, const std::string& axis);

/// A table of verdicts, the hardest level first, then the limit of each value with its closed form.
std::string mapText(const MobilityMap& map);

/// Runs what is missing, and writes map.txt, map.csv, map.json and map.png. Throws as eventsCommand() does.
void mapCommand(const MapCommand& command);

} // namespace grouser::events

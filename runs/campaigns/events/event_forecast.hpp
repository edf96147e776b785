// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_plan.hpp"
#include "runs/campaigns/forecast/probe.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Estimated run time of a set of events.
namespace grouser::events {

/// Run time of one event: all levels and seeds in sequence.
struct EventTime {
  Event event{};
  int runs = 0;
  double grains = 0; ///< grains of the largest bed
  double here = 0;   ///< run time on this machine with all cores [s]
  double h200 = 0;   ///< run time on one NVIDIA H200 [s]
};

/// Probes the first level of each event for about a second, as `grouser plan` does, and scales it to the others by
/// steps and grains. A run is assumed to end when its course is driven at the commanded speed.
///
/// For an H200: 161 us a step of vehicle and soil up to 285,000 grains (docs/evidence/paper.md), 0.43 us more for each
/// thousand beyond that (docs/evidence/speed.md, Hertz contacts, many radii), a second of steps for the bed to settle.
/// Without grains the host does all the work: the same time as `here`.
std::vector<EventTime> timesOf(const EventPlan& plan, const std::filesystem::path& folder);

/// Table of the events and their sum.
std::string timesText(const std::vector<EventTime>& times);

} // namespace grouser::events

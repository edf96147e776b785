// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_plan.hpp"
#include "runs/campaigns/forecast/probe.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Estimated run time of a set of events.
namespace grouser::events {

/// Run time of one event, with all levels and seeds in sequence.
struct EventTime {
  Event event{};
  int runs = 0;
  double grains = 0; ///< number of grains of the largest bed
  double here = 0;   ///< run time on this machine with all cores [s]
  double h200 = 0;   ///< run time on one NVIDIA H200 [s]
};

/// Probes the first level of each event for about a second, as `grouser plan` does, and scales the time to the other
/// levels by steps and grains. Assumes that each vehicle completes its course at the commanded speed.
///
/// H200: 161 us per step of vehicle and soil up to 285,000 grains (docs/evidence/paper.md), 0.43 us more per further
/// thousand grains (docs/evidence/speed.md, Hertz contacts, many radii), and one simulated second to settle the bed.
/// Runs without grains use the CPU only: the same time as `here`.
std::vector<EventTime> timesOf(const EventPlan& plan, const std::filesystem::path& folder);

/// Table of the events and their sum.
std::string timesText(const std::vector<EventTime>& times);

} // namespace grouser::events

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_plan.hpp"
#include "runs/campaigns/forecast/probe.hpp"
#include "runs/jobs/pieces.hpp"

#include <functional>
#include <string>
#include <vector>

/// `grouser events`: the standard mobility events of a vehicle on a ground.
namespace grouser::events {

struct EventsCommand {
  EventOptions options;
  jobs::PieceOptions pieces; ///< resume, part, seconds, device, threads
  std::string folder;        ///< empty: out/events_VEHICLE_SOIL
  int jobs = 1;              ///< runs at the same time
  bool force = false;        ///< run again what has been run, and overwrite the folder
  bool plan = false;         ///< say how long it would take, and run nothing
  bool films = false;
  std::vector<std::string> against; ///< folders of other events, whose figures stand beside these
  double percent = 5;               ///< of the larger mean, within which verdicts call two figures equal
  std::string words;                ///< the whole command line
};

/// Runs what is missing, each run a process, and writes events.csv, events.json, events.txt and pictures of them, and
/// against.csv and against.txt with --against; a run whose vehicle does not make it is a result. Throws
/// base::InputError where a word is wrong, before anything is started, and base::SimulationError at the end where runs
/// have failed for a cause that is not the vehicle's.
void eventsCommand(const EventsCommand& command);

} // namespace grouser::events

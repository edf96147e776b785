// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_runs.hpp"

/// `grouser events`: the standard mobility events of a vehicle on a ground.
namespace grouser::events {

/// Runs what is missing, each run a process, and writes events.csv, events.json, events.txt and pictures of them, and
/// against.csv and against.txt with --against; a run whose vehicle does not make it is a result. Throws
/// base::InputError where a word is wrong, before anything is started, and base::SimulationError at the end where runs
/// have failed for a cause that is not the vehicle's.
void eventsCommand(const EventsCommand& command);

} // namespace grouser::events

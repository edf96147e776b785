// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_runs.hpp"

/// `grouser events`: the standard mobility events of a vehicle on a ground.
namespace grouser::events {

/// Performs the missing runs, each in a separate process, and writes events.csv, events.json, events.txt and pictures;
/// with --against also against.csv and against.txt. A no-go is a result, not an error. Throws base::InputError for
/// invalid options before any run starts, and base::SimulationError at the end if runs failed for reasons unrelated to
/// the vehicle.
void eventsCommand(const EventsCommand& command);

} // namespace grouser::events

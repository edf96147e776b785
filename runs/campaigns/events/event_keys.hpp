// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_table.hpp"

#include <string>
#include <vector>

/// Scene keys that define an event, so that a user cannot change them by --set or --axis.
namespace grouser::events {

/// Keys that the event, its level or another option of the command sets. A key stands for its whole section and for
/// its components: "hitch" includes hitch.slip, and "run.gravity" includes run.gravity.2.
std::vector<std::string> ownedKeys(Event event, const Trial& trial, const Course& course);

/// Error message for the first of `sets` ("key=value" or "~key") that changes an owned key or replaces a whole section;
/// empty if none does. It names the event and the option to use instead.
std::string refusal(const std::vector<std::string>& sets, Event event, const Trial& trial, const Course& course);

/// Throws this message as base::InputError.
void refuseOwnedKeys(const std::vector<std::string>& sets, Event event, const Trial& trial, const Course& course);

} // namespace grouser::events

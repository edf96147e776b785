// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

/// Ratios of measured to modelled times of one machine, in the user's cache for later plans.
namespace grouser::forecast {

/// Ratio [-] by the kind of work.
using Ratios = std::map<std::string, double>;

/// Stored ratios of `machine` (hardware, device, threads and build in words) from 1/100 to 100; empty if there are none
/// or the file is damaged.
Ratios keptRatios(const std::string& machine);

/// Adds ratios to the stored ones of `machine`, replacing those of the same kind. Ignores write errors: later plans
/// then use typical values.
void keepRatios(const std::string& machine, const Ratios& ratios);

} // namespace grouser::forecast

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

/// Ratios of measured to modelled times on one machine, stored in the user's cache for later plans.
namespace grouser::forecast {

/// Ratio [-] for each kind of work.
using Ratios = std::map<std::string, double>;

/// Stored ratios between 1/100 and 100 of `machine` (text with hardware, device, threads and build); empty if no ratios
/// are stored or the file is damaged.
Ratios keptRatios(const std::string& machine);

/// Adds ratios to the stored ones of `machine`, replacing those of the same kind. Ignores write errors: later plans
/// then use typical values.
void keepRatios(const std::string& machine, const Ratios& ratios);

} // namespace grouser::forecast

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

/// Ratios of measured to modelled times of one machine, in the user's cache for later plans.
namespace grouser::forecast {

/// Ratio [-] by the kind of work.
using Ratios = std::map<std::string, double>;

/// The ratios kept of `machine` (hardware, device, threads and build in words), those from 1/100 to 100; none where
/// nothing is kept or the file is damaged.
Ratios keptRatios(const std::string& machine);

/// Adds ratios to those kept of `machine`; a kind measured before is replaced. Failure to write is no error: a later
/// plan then uses typical values.
void keepRatios(const std::string& machine, const Ratios& ratios);

} // namespace grouser::forecast

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"

#include <filesystem>
#include <string>

namespace grouser::commands {

/// Energy check of a finished run in one line: residual and integration error over the energy converted.
std::string energyText(const output::Summary& summary);

/// Speed, slip, sinkage, and drive torque of a finished run of a vehicle, means over its steady part, a line each, with
/// error bars if its scene has been checked; empty without a vehicle. `beside`: folder of another run whose figures
/// stand in a second column; empty: none. A reason why the figures are inconclusive precedes them, unless it has been
/// printed as `incomplete`.
std::string driveFiguresText(const std::filesystem::path& folder, const std::filesystem::path& beside,
                             const std::string& incomplete);

} // namespace grouser::commands

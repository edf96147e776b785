// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"

#include <filesystem>
#include <string>

namespace grouser::commands {

/// Warning if the time-integration error of a finished run exceeds 5 % of the work of all forces, unless nothing moves
/// or the contacts are complementarity contacts; otherwise empty.
std::string integrationWarning(const output::Summary& summary);

/// Text if deformable soil sank by more than `tabulated`, i.e. scm.largest_sinkage [m]; "" otherwise.
std::string sinkageWarning(const output::Summary& summary, double tabulated);

/// Lines on the energy balance of a finished run: integrationWarning(), then residual and integration error over the
/// work of all forces.
std::string energyText(const output::Summary& summary);

/// Figures of a finished run of a vehicle, one per line: means of speed, slip, sinkage and drive torque over the steady
/// part, with [hitch] also of drawbar pull and motion resistance, with error bars if the scene has been checked. Empty
/// without a vehicle. `beside`: folder of another run to print in a second column; empty: no second column. A reason
/// why the figures are inconclusive precedes them, unless it equals `incomplete`, which has already been printed.
std::string driveFiguresText(const std::filesystem::path& folder, const std::filesystem::path& beside,
                             const std::string& incomplete);

} // namespace grouser::commands

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_options.hpp"

#include <filesystem>

/// Error bars of a scene's figures: by step, seed, extent of the bed, grain size, spheres, precision; and what each
/// costs.
namespace grouser::sweeps {

/// Runs what is missing, a process a run, and writes check.json, series.csv, costs.json and check.png into
/// the folder; settled beds are shared with other runs. A check that was killed goes on: its files are then the same as
/// those of one that was not, and of one with other `jobs`, but for costs.json and what shows it. With a budget the
/// cost of the first run decides what is made, and is kept in choice.json, so that a call that goes on makes the same
/// choice. With figures the runs are made look by look until their bars are as narrow as wanted: see check_goals.hpp.
///
/// A run that fails is a result: it is shown with its message, and the others go on. Throws InputError where the scene
/// or the options are wrong, before anything is started; SimulationError at the end where no run of the scene as it is
/// has ended, or where the skin of the neighbour lists changed a bit.
void runCheck(const std::filesystem::path& scene, const CheckOptions& options);

} // namespace grouser::sweeps

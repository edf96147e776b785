// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace grouser::sweeps {

/// Figures of one finished run, as a sweep's summary has them, with the error bars of the last check of its scene. As
/// JSON: `figures`, each with `name` (and unit, as a column of summary.csv) and `value` (null: none); `inconclusive`:
/// why they are, empty where they are sound; `steady_from` [s], from which on rows count; `check`: what is kept of the
/// last check (sweeps::keptCheckText()), or null; `note`: why there are no figures. Nothing is thrown: where the
/// resolved scene in the folder can no longer be read, as when its height-map is gone, the note says so.
std::string runFiguresText(const std::filesystem::path& folder);

} // namespace grouser::sweeps

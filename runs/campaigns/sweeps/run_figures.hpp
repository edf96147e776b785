// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace grouser::sweeps {

/// Figures of one finished run as in summary.csv, with the error bars of the last check of its scene. As JSON:
/// `figures`, each with `name` (with unit) and `value` (null: none); `inconclusive`: the reason, empty if valid;
/// `steady_from` [s], start of the steady part; `speed_range` [m/s], minimum and maximum of the hull's speed in it, or
/// null; `check`: the last check (sweeps::keptCheck()), or null; `note`: why there are no figures, e.g. an unreadable
/// scene. Throws nothing.
nlohmann::ordered_json runFigures(const std::filesystem::path& folder);

} // namespace grouser::sweeps

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace grouser::sweeps {

/// Figures of one finished run as in summary.csv, with the last check of its scene. JSON entries: `figures`, each with
/// `name` (with unit) and `value` (null if missing); `inconclusive`: reason, empty if the figures are valid;
/// `steady_from` [s]: start of the steady part; `speed_range` [m/s]: minimum and maximum speed of the hull in the
/// steady part, or null; `check`: result of sweeps::keptCheck(), or null; `note`: reason why there are no figures, e.g.
/// an unreadable scene. Does not throw.
nlohmann::ordered_json runFigures(const std::filesystem::path& folder);

} // namespace grouser::sweeps

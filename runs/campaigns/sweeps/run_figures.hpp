// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace grouser::sweeps {

/// Figures of one finished run as in summary.csv, with the error bars of the last check of its scene. As JSON:
/// `figures`, each with `name` (with unit) and `value` (null: none); `inconclusive`: the reason, empty if valid;
/// `steady_from` [s], start of the steady part; `check`: the last check (sweeps::keptCheckText()), or null; `note`: why
/// there are no figures, e.g. an unreadable scene. Throws nothing.
std::string runFiguresText(const std::filesystem::path& folder);

} // namespace grouser::sweeps

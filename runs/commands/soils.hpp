// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace grouser::commands {

/// Constants of the soils of assets/soils, as the Markdown table of docs/soils.md.
std::string soilsTable();

/// Soils that a scene in `folder` can use by name, one per line.
std::string soilsList(const std::filesystem::path& folder);

/// All data of a soil file. Throws base::InputError for an unknown name or path.
std::string soilText(const std::string& word, const std::filesystem::path& folder);

} // namespace grouser::commands

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace grouser::commands {

/// What is known of the soils of assets/soils, as the Markdown table of docs/soils.md.
std::string soilsTable();

/// The soils that a scene in `folder` can take by name, a line each.
std::string soilsList(const std::filesystem::path& folder);

/// All that the file of a soil says of it. Throws base::InputError for a name or path that is none.
std::string soilText(const std::string& word, const std::filesystem::path& folder);

} // namespace grouser::commands

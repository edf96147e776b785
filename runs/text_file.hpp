// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace grouser::runs {

/// Writes a whole text file. Throws base::InputError where it cannot be begun, naming `option` as the way to another
/// place, and std::runtime_error where it cannot be ended, as on a full disk: no part of it is left then.
void writeTextFile(const std::filesystem::path& path, const std::string& text, const std::string& option);

} // namespace grouser::runs

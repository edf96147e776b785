// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

/// Checks, before any work, that results can be written.
namespace grouser::support {

/// Throws base::InputError with cause and remedy where nothing can be written in `folder`, or where it is not there and
/// cannot be made: a file or a link to nothing stands in its way, its name is too long, the file system is read-only
/// or full. Tries it beside or in the folder, and leaves nothing behind.
void requireFolder(const std::filesystem::path& folder, const std::string& option = "--out");

/// The same of a file, which may be there already; its folder must be.
void requireFile(const std::filesystem::path& file, const std::string& option);

} // namespace grouser::support

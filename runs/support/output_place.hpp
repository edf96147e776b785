// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

/// Checks, before any work, that results can be written.
namespace grouser::support {

/// Throws base::InputError with cause and remedy if `folder` is not writable, or is missing and cannot be created: a
/// file or a broken link blocks its path, its name is too long, or the file system is read-only or full. Tries to write
/// in the folder or above it, and leaves no file.
void requireFolder(const std::filesystem::path& folder, const std::string& option = "--out");

/// The same for a file. The file may exist; its folder must exist.
void requireFile(const std::filesystem::path& file, const std::string& option);

} // namespace grouser::support

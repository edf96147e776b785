// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace grouser::support {

/// Writes a whole text file. Throws base::InputError if it cannot be opened, with `option` as the option that selects
/// another file, and NotWritten if writing fails, e.g. on a full disk; then no partial file is left.
void writeTextFile(const std::filesystem::path& path, const std::string& text, const std::string& option);

/// Writes a text file of a run as path + ".part" and renames it, so that readers of `path` find either the former or
/// the new file, complete. On failure, throws NotWritten and leaves `path` unchanged. `room` [bytes]: space that the
/// new file reserves to grow even when the disk is full.
void replaceTextFile(const std::filesystem::path& path, const std::string& text, std::uint64_t room = 0);

/// For a full disk: overwrites the existing file within its allotted space. A kill in the middle leaves neither text.
/// Throws NotWritten.
void overwriteTextFile(const std::filesystem::path& path, const std::string& text);

} // namespace grouser::support

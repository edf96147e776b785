// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace grouser::support {

/// Writes a whole text file. Throws base::InputError where it cannot be opened, naming `option` as the way to another
/// place, and NotWritten where writing fails, as on a full disk: then no partial file is left.
void writeTextFile(const std::filesystem::path& path, const std::string& text, const std::string& option);

/// Writes a text file of a run under another name (path + ".part") and puts it in place by renaming: whoever reads
/// `path` finds the former file or the new one, whole. Throws NotWritten, with `path` as it was, where that
/// fails.
/// With `room` [bytes] the new file can grow by so much even when the disk is full.
void replaceTextFile(const std::filesystem::path& path, const std::string& text, std::uint64_t room = 0);

/// For a full disk: overwrites the existing file within its allotted space. A kill in the middle leaves neither text.
/// Throws NotWritten.
void overwriteTextFile(const std::filesystem::path& path, const std::string& text);

} // namespace grouser::support

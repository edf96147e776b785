// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

namespace grouser::support {

/// Ensures that the file can grow by `bytes`: preallocates them beyond its end if the file system supports this, and
/// checks the limit of file sizes (ulimit -f). A full disk is thus detected before the first byte of a block is
/// written. The file does not become longer. Throws NotWritten with the file's name.
void requireRoom(const std::filesystem::path& path, std::uint64_t bytes);
/// The same for an open file, which may have been renamed; `path`: name for the message.
void requireRoom(int file, const std::filesystem::path& path, std::uint64_t bytes);

} // namespace grouser::support

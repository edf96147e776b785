// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

namespace grouser::support {

/// Makes sure that the file can grow by `bytes`, without making it longer: allots them on the disk behind its end,
/// where the file system can, and compares with the limit to the size of files (ulimit -f). So a full disk is detected
/// before the first byte of a block is written. Throws NotWritten with the file's name.
void requireRoom(const std::filesystem::path& path, std::uint64_t bytes);
/// The same for an open file, which may have been renamed; `path` is for the message.
void requireRoom(int file, const std::filesystem::path& path, std::uint64_t bytes);

} // namespace grouser::support

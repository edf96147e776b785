// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

/// Atomic files: written under another name, sealed with length and checksum, and renamed. A program killed at any time
/// leaves the former file unchanged.
namespace grouser::support {

/// Bytes at the start of a file that the seal takes; the writer leaves them free. HDF5 calls this a user block.
inline constexpr std::size_t kSealBytes = 512;

/// Calls `write` with the name of a file to be made beside `path`, seals what it wrote as `kind` of `version`, and
/// flushes it to the disk before it takes `path`'s place. Throws NotWritten, with `path` as it was, when any of
/// it fails. On several ranks all of them write, and one seals; all return when the file is in place.
void writeSealed(const std::filesystem::path& path, const char* kind, int version,
                 const std::function<void(const std::filesystem::path& part)>& write, const base::Comm& comm = {});

/// Reads the whole file and throws base::InputError unless it is a `kind` of `version`, as long and with every bit as
/// it was written.
void checkSeal(const std::filesystem::path& path, const char* kind, int version);

/// As checkSeal(); returns the contents after the seal.
std::string readSealed(const std::filesystem::path& path, const char* kind, int version);

/// Waits until what was written to a file is on the disk.
void syncFile(const std::filesystem::path& path);

} // namespace grouser::support

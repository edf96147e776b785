// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

/// Atomic files: written under a temporary name, sealed with length and checksum, then renamed. If the program is
/// killed at any time, the former file remains unchanged.
namespace grouser::support {

/// Bytes at the start of a file that are reserved for the seal (user block of HDF5).
inline constexpr std::size_t kSealBytes = 512;

/// Calls `write` with the name of a new file beside `path`, seals this file as `kind` of `version`, flushes it to the
/// disk, and then renames it to `path`. On failure, throws NotWritten and leaves `path` unchanged. On several ranks,
/// all ranks write and one rank seals; all return after the rename.
void writeSealed(const std::filesystem::path& path, const char* kind, int version,
                 const std::function<void(const std::filesystem::path& part)>& write, const base::Comm& comm = {});

/// Reads the whole file. Throws base::InputError unless it is a `kind` of `version` with the right length and checksum.
void checkSeal(const std::filesystem::path& path, const char* kind, int version);

/// Like checkSeal(); returns the contents after the seal.
std::string readSealed(const std::filesystem::path& path, const char* kind, int version);

/// Waits until all data written to a file are on the disk.
void syncFile(const std::filesystem::path& path);

} // namespace grouser::support

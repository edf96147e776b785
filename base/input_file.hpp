// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

/// Files that users name. Commands read regular files only: a device may have no end, a FIFO no writer, and files of
/// the kernel, such as /proc/kmsg, can block their reader although they count as regular files.
namespace grouser::base {

/// Why this path cannot be read as a file, after its links: " is a FIFO (a regular file is required)" or ": no such
/// file". Empty for a readable regular file. Never blocks.
std::string inputFault(const std::filesystem::path& path);

/// Throws InputError if the path cannot be read as a file: "PATH is a FIFO (a regular file is required); REMEDY".
void requireInput(const std::filesystem::path& path, const std::string& remedy);

/// Reads the whole file. Throws InputError as requireInput() does, and if reading fails.
std::string readInput(const std::filesystem::path& path, const std::string& remedy);

} // namespace grouser::base

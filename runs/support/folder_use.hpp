// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/file_lock.hpp"

#include <filesystem>
#include <string>

/// Folders that one command uses at a time.
namespace grouser::support {

/// Process other than this one that holds a FileLock on this file or folder, and its start: "process 4711 since
/// 2026-11-30 14:02:10". Empty if there is none, or if the system does not list it (locks of other computers).
std::string lockHolder(const std::filesystem::path& path);

/// Throws base::InputError if a FileLock holds this folder: "FOLDER: in use by process 4711 since
/// ...; wait until it ends, or choose another folder with --out". `option`: the option that names the folder.
void requireUnused(const std::filesystem::path& folder, const std::string& option = "--out");
/// Locks an existing folder with `lock`; the same error if another process holds it.
void claimUnused(FileLock& lock, const std::filesystem::path& folder, const std::string& option = "--out");

} // namespace grouser::support

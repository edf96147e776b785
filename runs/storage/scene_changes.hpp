// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/storage/checkpoint.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Differences between a scene and the scene of a stored state, and whether the state allows them.
namespace grouser::storage {

/// A key with different values in two resolved scenes, or that only one of them contains.
struct KeyChange {
  std::string key;
  std::optional<std::string> was, is; ///< as TOML; empty: missing
};

/// All changes, except changes of keys that never affect a state: duration and intervals, device, threads, skin,
/// max_overlap, [stop], [output], [parallel], and names of files, which are compared by their bytes.
std::vector<KeyChange> changedKeys(const std::string& was, const std::string& is);

/// Returns true if a key acts only after the start of the drive: speeds, torques, tables, ramp and course of [driver],
/// and [hitch].
bool actsInTheDrive(const std::string& key);

/// Key of the first input file with different bytes in two texts of setup::inputsOf(); empty: none.
std::string changedFile(const std::string& was, const std::string& is);

/// Differences of a branch from its original run.
struct BranchChanges {
  bool driver = false, hitch = false;
  bool any() const { return driver || hitch; }
};

/// Throws base::InputError with the key if the scene differs from that of the checkpoint in a key that affects the
/// state. `option`: option that the message suggests to omit. Returns the differences that act only during the drive.
BranchChanges checkSameScene(const Checkpoint& checkpoint, const std::filesystem::path& path,
                             const setup::Provenance& provenance, const char* option = "--resume");

} // namespace grouser::storage

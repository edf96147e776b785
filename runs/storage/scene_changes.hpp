// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/storage/checkpoint.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Differences between a scene and that of a state, and whether the state allows them.
namespace grouser::storage {

/// A key of a resolved scene with another value, or in one of two scenes only.
struct KeyChange {
  std::string key;
  std::optional<std::string> was, is; ///< as TOML; empty: missing
};

/// All changes except of keys that never affect a state: duration and intervals, device, threads, skin, max_overlap,
/// [stop], [output], [parallel], and names of files, which are compared by their bytes.
std::vector<KeyChange> changedKeys(const std::string& was, const std::string& is);

/// Whether a key acts only from the start of the drive: speeds, torques, tables, ramp and course of [driver], and
/// [hitch].
bool actsInTheDrive(const std::string& key);

/// Key of the first input file whose bytes differ from those of setup::inputsOf(); empty: none.
std::string changedFile(const std::string& was, const std::string& is);

/// Differences of a branch from its original run.
struct BranchChanges {
  bool driver = false, hitch = false;
  bool any() const { return driver || hitch; }
};

/// Throws base::InputError, naming the key, where the scene differs from the checkpoint's in a key that affects the
/// state; `option`: the option to omit, for the message. Returns the differences that act only in the drive.
BranchChanges checkSameScene(const Checkpoint& checkpoint, const std::filesystem::path& path,
                             const setup::Provenance& provenance, const char* option = "--resume");

} // namespace grouser::storage

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/storage/checkpoint.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// In what a scene differs from the one that a state came from, and which of it the state allows.
namespace grouser::storage {

/// A key of a resolved scene that has another value, or stands in one of two scenes alone.
struct KeyChange {
  std::string key;
  std::optional<std::string> was, is; ///< as TOML; empty: it is not there
};

/// All but keys that never shape a state: duration and intervals, device, threads, skin, max_overlap, [stop], [output],
/// [parallel], and names of files, which are compared by their bytes.
std::vector<KeyChange> changedKeys(const std::string& was, const std::string& is);

/// Whether a key acts only from the begin of the drive on: speeds, torques, tables, ramp and course of [driver], and
/// [hitch].
bool actsInTheDrive(const std::string& key);

/// The first file of the scene, by its key, whose bytes differ from those that setup::inputsOf() was taken of; empty:
/// none.
std::string changedFile(const std::string& was, const std::string& is);

/// What a branch has otherwise than the run it comes from.
struct BranchChanges {
  bool driver = false, hitch = false;
  bool any() const { return driver || hitch; }
};

/// Throws base::InputError, naming the key, where the scene differs from the checkpoint's in anything that has shaped
/// the state; `option`: what to leave away then. Returns what differs of that which acts in the drive alone.
BranchChanges checkSameScene(const Checkpoint& checkpoint, const std::filesystem::path& path,
                             const setup::Provenance& provenance, const char* option = "--resume");

} // namespace grouser::storage

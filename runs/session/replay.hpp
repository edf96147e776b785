// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace grouser::session {

/// Recorded inputs and final state hash of a run, from its folder, for a replay.
struct RecordedRun {
  std::filesystem::path folder;
  std::vector<coupling::Input> inputs; ///< in the order of their steps
  std::int64_t steps = 0;              ///< number of steps taken
  std::string stateHash;               ///< final hash; empty if not recorded
  std::string scene;                   ///< resolved scene as TOML
};
/// Reads results.h5 in the folder of a run. Throws base::InputError if there is none.
RecordedRun recordedRun(const std::filesystem::path& folder);

/// Applies recorded inputs at their steps.
class Replay {
public:
  Replay() = default;
  explicit Replay(std::vector<coupling::Input> inputs) : inputs_(std::move(inputs)) {}
  /// Applies the inputs due before the next step. Returns the number of steps until the next input, at most `most`.
  std::int64_t apply(coupling::Simulation& simulation, std::int64_t most);

private:
  std::vector<coupling::Input> inputs_;
  std::size_t next_ = 0;
};

} // namespace grouser::session

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

/// A run that is to be repeated without whoever set its inputs: what its folder says of it.
struct RecordedRun {
  std::filesystem::path folder;
  std::vector<coupling::Input> inputs; ///< in the order of their steps
  std::int64_t steps = 0;              ///< that it took
  std::string stateHash;               ///< at its end; empty where it was not taken
  std::string scene;                   ///< resolved scene as TOML
};
/// Reads results.h5 of a run's folder. Throws base::InputError where there is none.
RecordedRun recordedRun(const std::filesystem::path& folder);

/// Sets recorded inputs at their steps.
class Replay {
public:
  Replay() = default;
  explicit Replay(std::vector<coupling::Input> inputs) : inputs_(std::move(inputs)) {}
  /// Those that are due before the next step. Returns how many steps may be taken until the next one is, at most
  /// `most`.
  std::int64_t apply(coupling::Simulation& simulation, std::int64_t most);

private:
  std::vector<coupling::Input> inputs_;
  std::size_t next_ = 0;
};

} // namespace grouser::session

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/output/output.hpp"
#include "runs/session/run_request.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/support/stopwatch.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grouser::session {

/// Checkpoint of the current state, without rows and frames.
storage::Checkpoint checkpointOf(const coupling::Simulation& simulation, const setup::Provenance& provenance);

/// The checkpoint of a run, which is rewritten repeatedly.
class Checkpoints {
public:
  Checkpoints(const setup::Provenance& provenance, const RunRequest& options);

  void write(const coupling::Simulation& simulation, output::RunWriter& writer);
  /// Keeps the current state in memory for the checkpoint of a failed run, at most once per pause. Call between rows:
  /// the number of rows belongs to the state.
  void remember(const coupling::Simulation& simulation, const output::RunWriter& writer);
  /// Writes the last remembered state of a failed run, unless a later state has been written.
  void writeRemembered(const coupling::Simulation& simulation, output::RunWriter& writer);
  /// File and step of the last checkpoint, "out/hills/checkpoint.h5, step 1000"; empty if there is none.
  std::string last() const;
  /// Sets the checkpoint that the run resumes or branches from.
  void goOnFrom(const storage::Checkpoint& former, bool branch) {
    checkpoint_.branchedFrom = former.branchedFrom;
    if (branch) return;
    writtenAt_ = former.state.steps;
    writtenInputs_ = former.state.inputs.size() / coupling::Input::kNumbers;
  }

private:
  void describe(const coupling::Simulation& simulation, std::int64_t rows, std::int64_t frames);

  std::filesystem::path path_;
  storage::Checkpoint checkpoint_;
  std::int64_t writtenAt_ = -1;
  std::size_t writtenInputs_ = 0; ///< number of inputs in that checkpoint
  std::optional<coupling::SimulationState> good_;
  std::int64_t goodRows_ = 0, goodFrames_ = 0;
  double pause_ = 0; ///< until the next time [s]
  support::Stopwatch sinceRemembered_;
};

} // namespace grouser::session

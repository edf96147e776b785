// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/checkpoints.hpp"

#include "runs/support/build_info.hpp"
#include "runs/support/not_written.hpp"

#include <fmt/format.h>

#include <utility>

namespace grouser::session {

namespace {

constexpr int kRememberPause = 200;               ///< pause / time to copy the state: half a percent of a run
constexpr std::size_t kMaxRemembered = 2'000'000; ///< grains: half a gigabyte

} // namespace

storage::Checkpoint checkpointOf(const coupling::Simulation& simulation, const setup::Provenance& provenance) {
  storage::Checkpoint checkpoint;
  checkpoint.scene = provenance.resolved, checkpoint.inputs = provenance.inputs;
  checkpoint.commit = support::buildInfo().commit, checkpoint.timeStep = simulation.timeStep();
  if (const auto& grains = simulation.ground().grains) checkpoint.lengths = storage::lengthsOf(*grains);
  checkpoint.state = simulation.save();
  return checkpoint;
}

Checkpoints::Checkpoints(const setup::Provenance& provenance, const RunRequest& options)
    : path_(options.folder / storage::kCheckpointName) {
  checkpoint_.scene = provenance.resolved;
  checkpoint_.inputs = provenance.inputs;
  checkpoint_.commit = support::buildInfo().commit;
}

void Checkpoints::write(const coupling::Simulation& simulation, output::RunWriter& writer) {
  const std::size_t inputs = simulation.inputs().series().size();
  if (writtenAt_ == simulation.steps() && writtenInputs_ == inputs) return;
  writer.sync();
  describe(simulation, writer.rows(), writer.frames());
  checkpoint_.state = simulation.save();
  storage::writeCheckpoint(path_, checkpoint_, simulation.comm());
  checkpoint_.state = {};
  writtenAt_ = simulation.steps(), writtenInputs_ = inputs;
}

void Checkpoints::remember(const coupling::Simulation& simulation, const output::RunWriter& writer) {
  const auto& grains = simulation.ground().grains;
  if (!simulation.comm().alone() || sinceRemembered_.seconds() < pause_) return;
  if (grains && grains->count() > kMaxRemembered) return;
  const support::Stopwatch saving;
  good_ = simulation.save();
  goodRows_ = writer.rows(), goodFrames_ = writer.frames();
  pause_ = kRememberPause * saving.seconds(), sinceRemembered_ = {};
}

void Checkpoints::writeRemembered(const coupling::Simulation& simulation, output::RunWriter& writer) {
  if (!good_ || good_->steps <= writtenAt_) return;
  try {
    writer.sync();
  } catch (const support::NotWritten&) {
    // These files may be the cause of the failure. The rows up to here are complete.
  }
  describe(simulation, goodRows_, goodFrames_);
  checkpoint_.state = std::move(*good_);
  good_.reset();
  storage::writeCheckpoint(path_, checkpoint_, simulation.comm());
  writtenAt_ = checkpoint_.state.steps;
}

std::string Checkpoints::last() const {
  return writtenAt_ < 0 ? "" : fmt::format("{}, step {}", path_.string(), writtenAt_);
}

void Checkpoints::describe(const coupling::Simulation& simulation, std::int64_t rows, std::int64_t frames) {
  checkpoint_.timeStep = simulation.timeStep(), checkpoint_.rows = rows, checkpoint_.frames = frames;
  if (const auto& grains = simulation.ground().grains) checkpoint_.lengths = storage::lengthsOf(*grains);
}

} // namespace grouser::session

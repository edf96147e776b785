// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/session/checkpoints.hpp"
#include "runs/session/recorder.hpp"
#include "runs/session/replay.hpp"
#include "runs/session/signal_watch.hpp"
#include "runs/support/not_written.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace grouser::session {

/// A simulation and its results folder: writes rows, frames and checkpoints at their times, and ends the run. Each rank
/// has a RunSession, and all ranks make the same calls.
class RunSession {
public:
  /// `simulation` and `record` must outlive it. `former`: checkpoint that the run resumes or branches from, or null;
  /// `total`: last step of the run. Makes the folder.
  RunSession(coupling::Simulation& simulation, const setup::RecordSetup& record, const RunRequest& request,
             const base::Exec& exec, const storage::Checkpoint* former, std::int64_t total);

  /// From now on, applies these inputs at their steps.
  void replay(std::vector<coupling::Input> inputs) { replay_ = Replay(std::move(inputs)); }
  /// Writes the first row and frame of a run that does not resume from a checkpoint.
  void begin();
  /// Returns true if steps are left before the end, a condition of [stop], or the start of the drive if the request
  /// ends there.
  bool continues() const;
  /// Returns true if the next step is the first step of the drive or a later one.
  bool isAtRest() const { return simulation_.vehicle() && stepsToDrive() == 0; }
  /// Takes at least one and at most `most` steps, up to the next row, frame or checkpoint, and writes due output. After
  /// a signal, writes a checkpoint and throws Stopped.
  void advance(std::int64_t most);
  /// Checks the energy, and writes the last checkpoint, row, frame and surface.
  void end();

  /// Marks the run as stopped; replaces end().
  void stop(const std::string& reason) {
    noteSteps(0);
    writer().stop(reason);
  }

  /// Calls `write`. After an exception, writes the state before the fault as a checkpoint, the current state as frame
  /// and picture, and the message in the manifest, then rethrows with the name of the checkpoint in the message.
  template <class Write> void record(const Write& write);

  coupling::Simulation& simulation() { return simulation_; }
  Recorder& recorder() { return recorder_; }
  output::RunWriter& writer() { return recorder_.writer(); }
  std::int64_t total() const { return total_; }

private:
  std::int64_t stepsToDrive() const;
  void writeInputs();
  /// Records the number of steps for a replay of an unfinished run, including `tried` failed ones.
  void noteSteps(std::int64_t tried);
  void leaveState();
  void leaveCheckpoint();
  std::string withCheckpoint(const std::string& message) const;
  std::string atStep(const std::string& message) const;
  /// Ends the run with this error, which names the last checkpoint.
  template <class Error, class... With> [[noreturn]] void abandon(const std::string& what, With... with) {
    const std::string message = withCheckpoint(what);
    noteSteps(1);
    writer().abandon(message, with...);
    throw Error(message, with...);
  }

  coupling::Simulation& simulation_;
  const setup::RecordSetup& record_;
  bool resumed_, untilRest_;
  std::int64_t total_, rowEvery_, frameEvery_, saveEvery_; ///< [steps]
  std::size_t inputsWritten_ = 0;
  Recorder recorder_;
  Checkpoints checkpoints_;
  SignalWatch signals_;
  Replay replay_;
};

template <class Write> void RunSession::record(const Write& write) {
  try {
    write();
  } catch (const support::Stopped& stopped) {
    stop(stopped.what());
    throw;
  } catch (const base::SimulationError& error) {
    leaveState();
    abandon<base::SimulationError>(error.what(), error.cause());
  } catch (const support::NotWritten& error) {
    leaveCheckpoint();
    abandon<support::NotWritten>(error.what());
  } catch (const base::DeviceError& error) {
    leaveCheckpoint();
    abandon<base::DeviceError>(atStep(error.what()));
  } catch (const std::exception& error) {
    writer().abandon(error.what());
    throw;
  }
}

} // namespace grouser::session

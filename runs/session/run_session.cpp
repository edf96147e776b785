// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/run_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

namespace grouser::session {

namespace {

std::int64_t stepsOf(double interval, double timeStep) {
  return std::max<std::int64_t>(1, std::llround(interval / timeStep));
}

} // namespace

RunSession::RunSession(coupling::Simulation& simulation, const setup::RecordSetup& record, const RunRequest& request,
                       const base::Exec& exec, const storage::Checkpoint* former, std::int64_t total)
    : simulation_(simulation), record_(record), resumed_(former != nullptr), untilRest_(request.untilRest),
      total_(total), rowEvery_(stepsOf(record.run.outputInterval, simulation.timeStep())),
      frameEvery_(stepsOf(record.run.frameInterval, simulation.timeStep())),
      saveEvery_(record.run.checkpointInterval > 0 ? stepsOf(record.run.checkpointInterval, simulation.timeStep())
                                                   : total + 1),
      recorder_(simulation, record, request, exec, request.branch ? nullptr : former, total),
      checkpoints_(record.provenance, request), signals_(simulation.comm()) {
  if (!former) return;
  checkpoints_.goOnFrom(*former, request.branch);
  if (former->branchedFrom) writer().fact("branched_from", former->branchedFrom->text());
}

void RunSession::begin() {
  if (resumed_) return;
  recorder_.row(), recorder_.frame();
  checkpoints_.remember(simulation_, writer());
}

bool RunSession::continues() const {
  const coupling::VehicleRig* rig = simulation_.vehicle();
  return simulation_.steps() < total_ && !(rig && !rig->ended().empty()) && !(untilRest_ && isAtRest());
}

/// Number of steps to the drive. While the driver waits for rest: number of steps to the next check of the vehicle.
std::int64_t RunSession::stepsToDrive() const {
  constexpr double kRounding = 1e-6; // [steps]
  const std::optional<double> start = simulation_.vehicle()->driveStart();
  if (!start) return coupling::VehicleRig::kAlarmInterval - simulation_.steps() % coupling::VehicleRig::kAlarmInterval;
  const double steps = std::ceil((*start - simulation_.time()) / simulation_.timeStep() - kRounding);
  return static_cast<std::int64_t>(std::max(0.0, steps));
}

void RunSession::advance(std::int64_t most) {
  most = replay_.apply(simulation_, most);
  const auto until = [now = simulation_.steps()](std::int64_t every) { return every - now % every; };
  if (untilRest_) most = std::min(most, stepsToDrive());
  simulation_.advance(
      std::min({most, total_ - simulation_.steps(), until(rowEvery_), until(frameEvery_), until(saveEvery_)}));
  const std::int64_t now = simulation_.steps();
  writeInputs();
  if (now % rowEvery_ == 0) recorder_.row();
  if (now % frameEvery_ == 0) recorder_.frame();
  if (now % rowEvery_ == 0) checkpoints_.remember(simulation_, writer());
  if (now % saveEvery_ == 0) checkpoints_.write(simulation_, writer());
  if (const int signal = signals_.receivedAt(now)) {
    checkpoints_.write(simulation_, writer());
    throw support::Stopped(signal, fmt::format("stopped by {} at {:.6g} s ({})", support::StopSignals::name(signal),
                                               simulation_.time(), checkpoints_.last()));
  }
}

void RunSession::writeInputs() {
  const std::size_t made = simulation_.inputs().series().size();
  if (made == inputsWritten_) return;
  writer().inputs(simulation_.inputs().save());
  inputsWritten_ = made;
}

void RunSession::noteSteps(std::int64_t tried) {
  try {
    writeInputs();
    writer().fact("steps_taken", std::to_string(simulation_.steps() + tried));
  } catch (const std::exception&) {
    // For example a full disk. The caller reports the error that ended the run.
  }
}

void RunSession::end() {
  simulation_.checkEnergy(); // the end may be between two regular checks
  replay_.apply(simulation_, 0);
  writeInputs(); // inputs that were set after the last step belong to the state
  // Written before the last row, since a run that resumes from this checkpoint does not contain that row.
  checkpoints_.write(simulation_, writer());
  // The final state is always written, even between output times.
  if (simulation_.steps() % rowEvery_ != 0) recorder_.row();
  if (simulation_.steps() % frameEvery_ != 0) recorder_.frame();
  recorder_.finalSurface();
}

/// After a fault: writes the state before the fault as a checkpoint, and the current state as frame and picture.
void RunSession::leaveState() {
  if (!simulation_.comm().alone()) return; // the fault may have occurred on some ranks only
  try {
    checkpoints_.writeRemembered(simulation_, writer());
    recorder_.lastFrame();
    if (record_.output.picture) recorder_.picture(record_.output.pictureWidth);
  } catch (const std::exception&) {
    // The user gets the error that ended the run, not this one.
  }
}

/// After a failure of a file or the device: writes the last good state from host memory, if the disk has space.
void RunSession::leaveCheckpoint() {
  if (!simulation_.comm().alone()) return;
  try {
    checkpoints_.writeRemembered(simulation_, writer());
  } catch (const std::exception&) {
    // The user gets the error that ended the run, not this one.
  }
}

std::string RunSession::withCheckpoint(const std::string& message) const {
  const std::string last = checkpoints_.last();
  return last.empty() ? message : fmt::format("{} (last checkpoint: {})", message, last);
}

std::string RunSession::atStep(const std::string& message) const {
  return fmt::format("step {}, time {:.4g} s: {}", simulation_.steps(), simulation_.time(), message);
}

} // namespace grouser::session

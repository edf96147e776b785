// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/run_request.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/stop_signals.hpp"

#include <filesystem>
#include <utility>

namespace grouser::commands {

/// A signal has stopped a branch, which left this checkpoint.
class StoppedBranch : public support::Stopped {
public:
  StoppedBranch(const support::Stopped& stopped, std::filesystem::path checkpoint)
      : Stopped(stopped), checkpoint_(std::move(checkpoint)) {}
  const std::filesystem::path& checkpoint() const { return checkpoint_; }

private:
  std::filesystem::path checkpoint_;
};

/// Runs a scene to its end and writes its results folder through a RunWriter. The returned summary is also stored in
/// the manifest; with `hash` it contains the state hash. Writes a checkpoint at the scene's interval, at the end, and
/// when SIGINT or SIGTERM stops the run. A failed run leaves files for diagnosis. Throws InputError,
/// SimulationError, DeviceError, Stopped or StoppedBranch.
output::Summary runScene(const scene::Scene& scene, const setup::Provenance& provenance,
                         const session::RunRequest& options);

} // namespace grouser::commands

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/run_request.hpp"
#include "runs/setup/provenance.hpp"

namespace grouser::commands {

/// Runs a scene, of this provenance, to its end and writes its folder through a RunWriter; the returned summary is also
/// in the manifest. With `hash` the summary holds the state hash. Leaves a checkpoint at the scene's interval, at the
/// end, and where SIGINT or SIGTERM stops the run. A failed run leaves files for diagnosis. Throws InputError,
/// SimulationError, DeviceError, or Stopped.
output::Summary runScene(const scene::Scene& scene, const setup::Provenance& provenance,
                         const session::RunRequest& options);

} // namespace grouser::commands

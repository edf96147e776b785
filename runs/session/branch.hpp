// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation_setup.hpp"
#include "runs/session/run_request.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/storage/checkpoint.hpp"

namespace grouser::session {

/// Makes the checkpoint of another run the start of this run. The scene, compiled to `setup`, may have a different
/// driver and hitch. Rows and frames start anew. All ranks call it. Throws base::InputError.
void branch(storage::Checkpoint& former, const setup::Provenance& provenance, const coupling::SimulationSetup& setup,
            const RunRequest& request);

} // namespace grouser::session

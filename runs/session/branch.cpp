// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/branch.hpp"

#include "coupling/branch.hpp"
#include "runs/storage/scene_changes.hpp"

namespace grouser::session {

void branch(storage::Checkpoint& former, const setup::Provenance& provenance, const coupling::SimulationSetup& setup,
            const RunRequest& request) {
  former.branchedFrom = storage::branchPoint(*request.resume, former, request.comm());
  former.rows = former.frames = 0;
  const storage::BranchChanges changes =
      storage::checkSameScene(former, *request.resume, provenance, request.names.resume);
  if (changes.any())
    coupling::branch(former.state, *setup.vehicle, changes.driver, changes.hitch,
                     static_cast<double>(former.state.steps) * former.timeStep);
}

} // namespace grouser::session

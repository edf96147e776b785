// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/ground_kinds.hpp"

#include "base/error.hpp"
#include "coupling/granular_ground.hpp"
#include "coupling/rigid_ground.hpp"

namespace grouser::coupling {

std::unique_ptr<Ground> makeGround(LaidGround& laid, const GroundSetup& setup, const base::Exec& exec) {
  if (setup.otherKind && laid.grains)
    throw base::InputError(
        "the scene has grains and another kind of ground, which do not interact; remove one of them");
  if (setup.otherKind) return setup.otherKind(setup, exec);
  if (laid.grains) return std::make_unique<GranularGround>(laid, setup, exec);
  if (laid.rigid) return std::make_unique<RigidGround>(laid);
  return nullptr;
}

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground.hpp"
#include "coupling/laid_ground.hpp"

#include <memory>

namespace grouser::coupling {

/// The ground of a scene: of the kind that `setup` names, else grains where some were laid, else rigid ground; null
/// where there is neither. Both outlive it.
std::unique_ptr<Ground> makeGround(LaidGround& laid, const GroundSetup& setup, const base::Exec& exec);

} // namespace grouser::coupling

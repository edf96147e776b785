// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground.hpp"
#include "coupling/laid_ground.hpp"

#include <memory>

namespace grouser::coupling {

/// Creates the ground of a scene: of the kind in `setup`, else granular if there are grains, else rigid; null if there
/// is neither. Both arguments must outlive the ground.
std::unique_ptr<Ground> makeGround(LaidGround& laid, const GroundSetup& setup, const base::Exec& exec);

} // namespace grouser::coupling

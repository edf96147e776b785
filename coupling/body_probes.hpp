// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "multibody/state.hpp"
#include "terrain/grains.hpp"

#include <cstddef>
#include <vector>

namespace grouser::coupling {

/// Box fixed to a body, along the axes of its frame B, in which the grain mass is measured.
struct BodyProbe {
  std::size_t body{};     ///< index into the model's bodies
  base::Vec3d half;       ///< half edges [m]
  base::Vec3d position_B; ///< centre of the box in the body frame [m]
};

/// [probe] mass of the grains with centres in the box [kg], independent of the number of ranks. Collective.
std::vector<double> grainMassIn(const std::vector<BodyProbe>& probes, const multibody::State& state,
                                const terrain::Grains& grains, const base::Comm& comm);

} // namespace grouser::coupling

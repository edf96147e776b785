// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "multibody/state.hpp"
#include "terrain/grains.hpp"

#include <cstddef>
#include <vector>

namespace grouser::coupling {

/// A box fixed to a body, along the axes of its frame B, within which grains are weighed.
struct BodyProbe {
  std::size_t body{};     ///< index into the model's bodies
  base::Vec3d half;       ///< half of its edges [m]
  base::Vec3d position_B; ///< of its centre, in the body's frame [m]
};

/// [probe] mass of the grains whose centres lie in it [kg], the same on any number of ranks. All ranks call it.
std::vector<double> grainMassIn(const std::vector<BodyProbe>& probes, const multibody::State& state,
                                const terrain::Grains& grains, const base::Comm& comm);

} // namespace grouser::coupling

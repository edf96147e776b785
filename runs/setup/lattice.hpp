// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/subdomain.hpp"
#include "runs/scene/scene.hpp"

#include <array>

namespace grouser::setup {

/// Numbers of subdomains along x, y and z that the scene sets, directly or by planes; 0: any number.
std::array<int, 3> requestedSubdomains(const scene::Scene& scene);

/// Options of [parallel], without communicator. `scale`: positions of the distributed elements.
contact::PartitionOptions partitionOptions(const scene::Scene& scene, const base::PositionScale& scale);

/// Throws base::InputError, with the line of the key, if the scene's lattice does not fit the number of ranks.
void checkLattice(const scene::Scene& scene, int ranks);

} // namespace grouser::setup

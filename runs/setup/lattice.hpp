// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/subdomain.hpp"
#include "runs/scene/scene.hpp"

#include <array>

namespace grouser::setup {

/// Subdomains along x, y and z that the scene sets, by numbers or by planes between them; 0: any number.
std::array<int, 3> wantedSubdomains(const scene::Scene& scene);

/// Options of [parallel], without communicator. `scale`: positions of the distributed elements.
contact::PartitionOptions partitionOptions(const scene::Scene& scene, const base::PositionScale& scale);

/// Throws base::InputError, with the line of the key, if the scene's lattice does not fit the number of ranks.
void checkLattice(const scene::Scene& scene, int ranks);

} // namespace grouser::setup

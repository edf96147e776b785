// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/subdomain.hpp"
#include "runs/scene/scene.hpp"

#include <array>

namespace grouser::setup {

/// Subdomains along x, y and z that the scene asks for, by their numbers or by planes between them; 0: any number.
std::array<int, 3> wantedSubdomains(const scene::Scene& scene);

/// Options of [parallel], without communicator. `scale`: positions of the elements that are divided.
contact::PartitionOptions partitionOptions(const scene::Scene& scene, const base::PositionScale& scale);

/// Throws base::InputError, with the line of the key, where so many ranks make no lattice that the scene asks for.
void checkLattice(const scene::Scene& scene, int ranks);

} // namespace grouser::setup

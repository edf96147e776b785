// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Removes grains between steps; `ids` must be ascending. The remaining grains keep their history and ids. Slow, since
/// it uses host copies. Returns the mass of the removed grains [kg]. Collective.
double removeGrains(Grains& grains, const std::vector<std::uint32_t>& ids);

} // namespace grouser::terrain

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Removes grains between steps; `ids` ascend. The others keep their history and ids. Slow, since it goes through the
/// host. Returns the mass of the removed grains [kg]. All ranks call it.
double removeGrains(Grains& grains, const std::vector<std::uint32_t>& ids);

} // namespace grouser::terrain

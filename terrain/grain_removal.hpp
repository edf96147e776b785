// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Takes grains out, between steps; `ids` ascend. What stays keeps its history and its ids. By way of the host, so
/// dear. Returns the mass of those that are gone [kg]. All ranks call it.
double removeGrains(Grains& grains, const std::vector<std::uint32_t>& ids);

} // namespace grouser::terrain

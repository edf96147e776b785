// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <cstdint>

namespace grouser::setup {

/// Grains of the bed; reads the height-map, for hills may need more.
std::int64_t bedGrains(const scene::Scene& scene);

/// Grains of a scene, those that enter later among them. Reads the height-map, for hills may need more.
std::int64_t plannedGrains(const scene::Scene& scene);

} // namespace grouser::setup

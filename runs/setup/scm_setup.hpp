// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/scm_ground.hpp"

#include <optional>

namespace grouser::scene {
struct Scene;
}

namespace grouser::setup {

/// Soil that deforms; empty where the scene has none. Constants as given, else those of its soil. Throws
/// base::InputError where a constant is missing, or where the soil would bear nothing under a shoe.
std::optional<coupling::ScmSetup> scmSetup(const scene::Scene& scene);

} // namespace grouser::setup

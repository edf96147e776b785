// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/scm_ground.hpp"

#include <optional>
#include <string>

namespace grouser::scene {
struct Scene;
}

namespace grouser::setup {

/// Deformable soil of a scene; empty for other terrain. Throws base::InputError if a constant is missing, if the soil
/// has no bearing capacity under a shoe, or if the scene has parts that deformable soil does not support.
std::optional<coupling::ScmSetup> scmSetup(const scene::Scene& scene);

/// Text if the nodes are farther apart than the default, with the error to be expected; "" otherwise.
std::string nodeSpacingWarning(const scene::Scene& scene);

} // namespace grouser::setup

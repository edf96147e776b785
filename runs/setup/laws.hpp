// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"

#include <optional>
#include <string>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// The law between two materials of a scene: contact::mixedLaw() with [contact."a|b"]. Throws InputError at the key if
/// the materials are incompatible. Call checkRestitutions() first.
contact::ContactLaw pairLaw(const scene::Scene& scene, const std::string& a, const std::string& b,
                            std::optional<double> effectiveMass);

} // namespace grouser::setup

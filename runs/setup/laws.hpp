// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"

#include <optional>
#include <string>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// The law between two materials of a scene: contact::mixedLaw() with what [contact."a|b"] says. Throws InputError at
/// the key where the two have none. Restitutions must be possible: see restitution_check.hpp.
contact::ContactLaw pairLaw(const scene::Scene& scene, const std::string& a, const std::string& b,
                            std::optional<double> effectiveMass);

} // namespace grouser::setup

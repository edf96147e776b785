// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/scene.hpp"

#include <string>

namespace grouser::runs {

/// Mass of a sphere [kg].
double sphereMass(double density, double radius);

/// The law between two materials for bodies of the given effective mass [kg].
///
/// A pair takes what [contact."a|b"] says; else stiffness in series doubled, 2 k_a k_b / (k_a + k_b), so that equal
/// materials keep theirs; the smaller friction, the smaller restitution, the smaller tangential ratios; attraction only
/// if both allow it. Damping follows from the restitution by the formula of the clamped or the free law.
contact::ContactLaw pairLaw(const Scene& scene, const std::string& a, const std::string& b, double effectiveMass);

} // namespace grouser::runs

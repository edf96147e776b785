// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/scene/scene.hpp"

#include <optional>
#include <string>

namespace grouser::setup {

/// The law between two materials. Damping follows from the restitution by the formula of the clamped or the free law,
/// for bodies of the given effective mass [kg], or where there is none for any (grains of many masses).
///
/// A pair takes what [contact."a|b"] says; else
/// - linear: stiffness in series doubled, 2 k_a k_b / (k_a + k_b), so that equal materials keep theirs;
/// - hertz: 1 / E_eff = (1 - nu_a^2) / E_a + (1 - nu_b^2) / E_b and 1 / G_eff = (2 - nu_a) / G_a + (2 - nu_b) / G_b;
/// - the smaller friction, rolling friction and restitution, the smaller tangential and rolling ratios; the geometric
///   mean of the cohesions; attraction only if both allow it.
/// Throws InputError where one is linear and the other hertz. Restitutions must be possible: see restitution_check.hpp.
contact::ContactLaw pairLaw(const scene::Scene& scene, const std::string& a, const std::string& b,
                            std::optional<double> effectiveMass);

/// Coefficients of a contact as stiff as it gets: of a linear one always, of a Hertz one at the deepest overlap of an
/// impact at `speed` [m/s].
contact::Coefficients<double> stiffest(const contact::ContactLaw& law, double effectiveMass, double effectiveRadius,
                                       double speed);

/// Duration of the undamped contact [s]; of a Hertz one at `speed` [m/s].
double contactTime(const contact::ContactLaw& law, double effectiveMass, double effectiveRadius, double speed);

/// Rebound over impact speed [-] that the law's dashpot makes where bodies of another effective mass meet, `movedMass`
/// [kg], than the one that its damping follows from.
double restitutionOf(const contact::ContactLaw& law, double effectiveMass, double movedMass);

/// Time of a Rayleigh wave along half a grain of a hertz material [s]; infinite for a linear one.
double rayleighTimeOf(const scene::Material& material, double radius);

} // namespace grouser::setup

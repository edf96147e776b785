// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/step_modes.hpp"

#include <limits>
#include <string>
#include <vector>

namespace grouser::setup {

/// Step of a vehicle without grains, e.g. on rigid ground [s].
inline constexpr double kVehicleTimeStep = 1e-4;

/// Largest automatic step / calm step [-]: at half the calm step, a disturbance decays within two or three steps; at
/// the calm step, it never decays.
inline constexpr double kCalmShare = 0.5;

/// Largest automatic step of hertz grains / Rayleigh time of the smallest grain [-].
inline constexpr double kRayleighShare = 0.2;

/// Both limits, from the possible contacts of grains and vehicle. They depend only on the scene:
/// - energy: a grain among twelve equal grains with springs 8 k / m, repulsive dashpots 4.5 c / m, and friction and
///   rolling resistance within Coulomb's limit; an impact at no more than half its own limit; a free surface on the
///   springs of all grains that it can carry; a shoe of the vehicle on its whole pad;
/// - calm: the bound of contact::stableStepOfMode for each mode of grains in non-sliding contact: translation,
///   rotation, rolling, among twelve grains or between two fixed bodies. `grouser study stability` compares the limits
///   with measured ones (docs/steps.md#validation-studies).
StepLimit stepLimit(const scene::Scene& scene);

/// Duration [s] of the shortest contact that a grain of the scene can have: pi / sqrt(k / m_eff) without damping, of
/// two grains, or of a grain and ground, plane or vehicle (damping prolongs contacts). 0 without grains.
double shortestContact(const scene::Scene& scene);

/// Step of the run [s]: as given and checked against the stability limit, or the automatic step. Throws InputError with
/// the limit and the contact that sets it.
double chooseTimeStep(const scene::Scene& scene);

/// Throws InputError if a surface moves more than half a grain radius per step, so that it could pass through a grain,
/// or if a grain starts or enters faster than the neighbour lists support.
void checkSpeeds(const scene::Scene& scene, const ContactPairs& pairs, double timeStep);

} // namespace grouser::setup

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/step_modes.hpp"

#include <limits>
#include <string>
#include <vector>

namespace grouser::setup {

/// Step of a vehicle on rigid ground, where no grain sets it [s].
inline constexpr double kVehicleTimeStep = 1e-4;

/// The largest automatic step over that at which motions of a bed still decay [-]: at half of it a disturbance decays
/// in two or three steps, at all of it never.
inline constexpr double kCalmShare = 0.5;

/// The largest automatic step of hertz grains, as a share of the time a Rayleigh wave takes along the smallest [-].
inline constexpr double kRayleighShare = 0.2;

/// Both limits from the contacts that grains and vehicle can have, a function of the scene only:
/// - energy: a grain among twelve others alike, whose springs are 8 k / m together, its dashpots 4.5 c / m where they
/// only push, friction and rolling resistance within what Coulomb's limit allows; an impact in at least half of its
/// own limit; a free surface on the springs of all grains that may lie on it; a shoe of the vehicle on its whole pad;
/// - calm: the bound of contact::stableStepOfMode for each mode of grains that are all in contact and do not slide:
/// shift, turn, rolling, among twelve others or between two bodies that do not give way. `grouser study stability`
/// measures how close they are (docs/steps.md#validation-studies).
StepLimit stepLimit(const scene::Scene& scene);

/// Duration [s] of the shortest contact that a grain of the scene can have: pi / sqrt(k / m_eff), undamped, of two
/// grains or of a grain and ground, plane or vehicle (the damped one lasts longer). 0 where there are no grains.
double shortestContact(const scene::Scene& scene);

/// Step of the run [s]: as the scene says, checked against the stability limit, or the largest sound one.
/// Throws InputError that names the limit and what sets it.
double chooseTimeStep(const scene::Scene& scene);

/// Throws InputError where a surface moves farther in a step than half a radius and could pass through a grain, and
/// where a grain starts or enters faster than the neighbour lists support.
void checkSpeeds(const scene::Scene& scene, const ContactPairs& pairs, double timeStep);

} // namespace grouser::setup

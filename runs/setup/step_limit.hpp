// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <limits>
#include <string>

namespace grouser::setup {

/// Step of a vehicle on rigid ground, where no grain sets it [s].
inline constexpr double kVehicleTimeStep = 1e-4;

/// The largest automatic step of hertz grains, as a share of the time a Rayleigh wave takes along the smallest [-].
inline constexpr double kRayleighShare = 0.2;

/// Steps that a contact should last at least: at 20 steps a collision's restitution is right within 2 %.
inline constexpr double kStepsPerContact = 20;

/// The largest stable step [s], infinite where nothing limits it, and what becomes unstable beyond it.
struct StepLimit {
  double step = std::numeric_limits<double>::infinity();
  std::string what;   ///< "grain on the floor"
  std::string remedy; ///< "lower its stiffness"
};

/// The step up to which a scene of grains and vehicle stays stable: for each mode that its contacts make, the bound of
/// contact::stableStepOfMode; a function of the scene alone. The modes are
/// - a grain among twelve others alike, all of them in contact and none sliding: its shift, its turn, its rolling;
/// - a grain between two bodies that do not give way: planes, surfaces, floor, parts;
/// - a free surface on the springs of all grains that may lie on it;
/// - a shoe of the vehicle on its whole pad.
/// `grouser study stability` measures how close the bounds are (docs/studies.md).
StepLimit stepLimit(const scene::Scene& scene);

/// Duration [s] of the shortest contact that a grain of the scene can have: pi / sqrt(k / m_eff), undamped, of two
/// grains or of a grain and ground, plane or vehicle (the damped one lasts longer). 0 where there are no grains.
double shortestContact(const scene::Scene& scene);

/// Step of the run [s]: as the scene says, checked against the stability limit, or the largest sound one.
/// Throws InputError that names the limit and what sets it.
double chooseTimeStep(const scene::Scene& scene);

/// Throws InputError where a surface goes farther in a step than half a radius: it could pass through a grain unfelt;
/// and where a grain starts or enters more quickly than the neighbour lists can follow.
void checkSpeeds(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup

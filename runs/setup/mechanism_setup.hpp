// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism_setup.hpp"

#include <string>
#include <vector>

namespace grouser::scene {
struct RunSettings;
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Throws SectionFault for invalid sections; a loaded scene has none.
coupling::MechanismSetup mechanismSetup(const scene::Scene& scene);

/// The mechanism without contact shapes, so that no mesh is converted to spheres.
coupling::MechanismSetup contactFreeSetup(const scene::Scene& scene);

/// Materials of the bodies' shapes, each once, in the order of the file.
std::vector<std::string> shapeMaterials(const scene::Scene& scene);

/// The options of the solver, from [run].
multibody::SolverOptions solverOptions(const scene::RunSettings& run);

/// Step of a mechanism [s]: as given, or "auto". At the start, "auto" is the minimum of: 1/100 of the shortest
/// oscillation of springs, revolution of a body or period of a drive; 1/20 of the shortest oscillation on taut joints
/// and of a bounce off an end stop; 1/run.steps_per_period of the smallest interval of a table; with rattle, the time
/// constant of the strongest damper; 1 ms. It divides the output interval. With run.tolerance: time between rows or
/// frames, which adaptive steps subdivide. Throws InputError if springs or dampers are unstable at this step, or if the
/// step does not resolve drives and rotations (time_scales.hpp) or a bounce off an end stop.
double mechanismTimeStep(const scene::Scene& scene);

/// Note, with a remedy, if a spring or damper makes "auto" use a million steps or more, or if a given step does not
/// resolve the oscillation of a spring; otherwise empty.
std::string springStepNote(const scene::Scene& scene);

/// Warning if the step exceeds the initial stability limit of taut joints and springs; a mechanism at rest becomes
/// unstable only after a disturbance. Empty if the step is short enough.
std::string tensionStepWarningAtStart(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup

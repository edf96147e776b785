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

/// Throws SectionFault for invalid sections, which loading has excluded.
coupling::MechanismSetup mechanismSetup(const scene::Scene& scene);

/// The mechanism without contact shapes, which needs no spheres of meshes.
coupling::MechanismSetup contactFreeSetup(const scene::Scene& scene);

/// Materials of the bodies' shapes, each once, in the order of the file.
std::vector<std::string> shapeMaterials(const scene::Scene& scene);

/// The solver's options as a scene's [run] gives them.
multibody::SolverOptions solverOptions(const scene::RunSettings& run);

/// Step of a mechanism [s]: as given, or "auto": at the start a hundredth of the shortest oscillation of the springs,
/// turn of a body or period of a drive, a twentieth of the shortest oscillation on taut joints and of a bounce off an
/// end stop, run.steps_per_period steps of the smallest interval of a table, with rattle the time constant of the
/// strongest damper; at most 1 ms, and a whole fraction of the output interval. With run.tolerance the time between two
/// rows or frames, which steps of the mechanism divide. Throws InputError where springs and dampers are unstable at
/// this step, or the step does not resolve drives and turns (time_scales.hpp) or a bounce off an end stop.
double mechanismTimeStep(const scene::Scene& scene);

/// Note where a spring or damper makes "auto" take a million steps or more, with a remedy, or where a given step does
/// not resolve the oscillation of a spring; otherwise empty.
std::string springStepNote(const scene::Scene& scene);

/// Warning for a step above the stability limit of taut joints and springs at the start; at rest it may hold until the
/// first disturbance. Empty where the step is short enough.
std::string tensionStepWarningAtStart(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup

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

/// Throws SectionFault where the sections make no mechanism: loading has made sure that they do.
coupling::MechanismSetup mechanismSetup(const scene::Scene& scene);

/// The mechanism without contact shapes: needs no sphere cuts of meshes.
coupling::MechanismSetup contactFreeSetup(const scene::Scene& scene);

/// Materials of the bodies' shapes, each once, in the order of the file.
std::vector<std::string> shapeMaterials(const scene::Scene& scene);

/// The solver's options as a scene's [run] gives them.
multibody::SolverOptions solverOptions(const scene::RunSettings& run);

/// Step of a mechanism [s]: as the scene says, or the one that "auto" stands for: at the start a hundredth of the
/// shortest swing of the springs, turn of a body or period of a drive, a twentieth of the shortest swing on taut joints
/// and of a bounce off an end stop, run.steps_per_period steps of the smallest gap of a table, of rattle the time in
/// which the strongest damper brakes; at most 1 ms, and a whole share of the output interval. With run.tolerance the
/// time between two places where rows and frames fall, which steps of the mechanism's own divide. Throws InputError
/// where the integrator cannot take springs and dampers at this step, or the step does not resolve drives and turns
/// (time_scales.hpp) or a bounce off an end stop.
double mechanismTimeStep(const scene::Scene& scene);

/// What is to be said where springs or dampers alone make "auto" choose a step that needs a million steps or more:
/// which, and how to do without; and where a step that is given does not resolve the swing of a spring. Empty else.
std::string springStepNote(const scene::Scene& scene);

/// What is to be said of a step above what joints and springs bear at the start: at rest it may do well, until the
/// first push. Empty where the step is short enough.
std::string tensionStepWarningAtStart(const scene::Scene& scene, double timeStep);

} // namespace grouser::setup

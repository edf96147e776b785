// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/output/output.hpp"
#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::commands {

/// Reason why a run that should drive its vehicle is incomplete: the vehicle never drove, or advanced by fewer `teeth`
/// than setup::kFewestTeeth. Empty if the vehicle drove far enough, or if the scene does not drive it.
std::string incompleteText(const scene::Scene& scene, const coupling::Simulation& simulation, double teeth);
/// Prints this reason as a warning and stores it in `summary`; then prints the start of the drive, the condition that
/// ended the run early, and blows. No warning if the run `endsAtRest`, as requested by --until rest.
void describeDrive(const scene::Scene& scene, const coupling::Simulation& simulation, double teeth,
                   output::Summary& summary, bool endsAtRest);

} // namespace grouser::commands

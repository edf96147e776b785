// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/output/output.hpp"
#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::commands {

/// Why the run of a vehicle that was to drive tells nothing of its driving: it did not begin, or passed fewer than
/// setup::kFewestTeeth `teeth`. Empty where it drove, and where the scene does not ask it to.
std::string incompleteText(const scene::Scene& scene, const coupling::Simulation& simulation, double teeth);
/// Prints and notes that, before all else that is said of the run; then when the vehicle drove off, and what has ended
/// the run before its time. A run that `endsAtRest`, as it was asked to, is not to drive.
void describeDrive(const scene::Scene& scene, const coupling::Simulation& simulation, double teeth,
                   output::Summary& summary, bool endsAtRest);

} // namespace grouser::commands

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::setup {

/// Teeth that a track must pass before means over them count: torque, speed and slip ripple with each tooth [-].
inline constexpr double kFewestTeeth = 2;

/// Below this a vehicle counts as not driven: its ramp has just begun [-].
inline constexpr double kLeastTeeth = 0.01;

/// Returns true if the driver turns the sprockets. A vehicle that only settles, or is towed by its hitch, need not
/// drive.
bool asksToDrive(const scene::Scene& scene);

/// Teeth that pass the faster sprocket by the end of the run [-] with the earliest start; infinite with torques.
/// `steady`: only those after the drive ramp.
double teethAsked(const scene::Scene& scene, bool steady = false);

/// The setting that lets a vehicle drive farther, as the end of a message.
std::string longerDriveRemedy(const scene::Scene& scene);

/// Warns before a run whose vehicle cannot pass kFewestTeeth in its duration, or none in steady motion; empty where it
/// can.
std::string shortDriveWarning(const scene::Scene& scene);

} // namespace grouser::setup

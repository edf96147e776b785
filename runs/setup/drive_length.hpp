// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::setup {

/// Minimum number of passed teeth for valid means [-]: torque, speed and slip ripple with each tooth.
inline constexpr double kFewestTeeth = 2;

/// Number of passed teeth below which a vehicle counts as not driven, since its ramp has just begun [-].
inline constexpr double kMinTeeth = 0.01;

/// Returns true if the driver turns the sprockets. A vehicle that only settles or is towed does not drive.
bool commandsDrive(const scene::Scene& scene);

/// Teeth that pass the faster sprocket by the end of the run [-] with the earliest start; infinite for given torques.
/// `steady`: only those after the drive ramp.
double requestedTeeth(const scene::Scene& scene, bool steady = false);

/// The setting that lets a vehicle drive farther, as the end of a message.
std::string longerDriveRemedy(const scene::Scene& scene);

/// Warning if the vehicle cannot pass kFewestTeeth within the duration of the run, or not one tooth in steady motion;
/// otherwise empty.
std::string shortDriveWarning(const scene::Scene& scene);

} // namespace grouser::setup

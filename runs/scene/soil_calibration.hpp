// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <array>
#include <string>
#include <vector>

/// At which sizes of grains what was measured of a soil holds.
namespace grouser::scene {

/// How far from the radii that a soil has been measured at it still counts as calibrated [-]: radii are named with two
/// or three digits, and the constants change by as much, a tenth of the intervals of measured ones.
inline constexpr double kCalibratedWithin = 0.01;

/// Whether grains of this radius [m] are of the sizes that a soil has been measured at.
bool isCalibratedSize(const std::array<double, 2>& calibratedRadii, double radius);

/// Where the scene's grains have sizes that its calibrated soils have not been measured at, a line each.
std::vector<std::string> soilWarnings(const Scene& scene);

} // namespace grouser::scene

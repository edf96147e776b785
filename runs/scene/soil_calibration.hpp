// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <array>
#include <string>
#include <vector>

/// Grain sizes for which the calibration of a soil holds.
namespace grouser::scene {

/// Relative tolerance of the calibrated radii of a soil [-]: radii have two or three digits, and the constants change
/// by as much, a tenth of the intervals of measured ones.
inline constexpr double kCalibratedWithin = 0.01;

/// Returns true if a grain radius [m] is in the calibrated range.
bool isCalibratedSize(const std::array<double, 2>& calibratedRadii, double radius);

/// Warnings on grain sizes for which the scene's soils are not calibrated, a line each.
std::vector<std::string> soilWarnings(const Scene& scene);

} // namespace grouser::scene

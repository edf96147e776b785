// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <array>
#include <string>
#include <vector>

/// Grain sizes for which the calibration of a soil is valid.
namespace grouser::scene {

/// Relative tolerance of the calibrated radii of a soil [-]: radii are given with two or three digits, and constants
/// change by about this fraction, a tenth of the intervals of measured constants.
inline constexpr double kCalibratedWithin = 0.01;

/// Returns true if a grain radius [m] is in the calibrated range.
bool isCalibratedSize(const std::array<double, 2>& calibratedRadii, double radius);

/// Warnings about grain sizes for which the scene's soils are not calibrated, one per line.
std::vector<std::string> soilWarnings(const Scene& scene);

} // namespace grouser::scene

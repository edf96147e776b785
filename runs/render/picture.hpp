// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"
#include "runs/render/image.hpp"
#include "runs/render/render.hpp"

namespace grouser::render {

/// Elevation of the camera for a vehicle, for a bed without vehicle, and for flat parts [deg].
inline constexpr double kVehicleElevation = 14, kBedElevation = 30, kFlatElevation = 60;
inline constexpr double kAzimuth = -55; ///< azimuth of the camera about z [deg]
/// Elevation and azimuth for a vehicle on deformable soil, from behind to show the ruts; factor on the distance.
inline constexpr double kRutElevation = 24, kRutAzimuth = -140, kRutDistance = 1.3;

Colour partColour(output::PartKind kind);

/// Grains of a picture of the bed, without outliers: a grain is an outlier if, along any axis, its distance from the
/// middle 98 % of the grains exceeds their extent along this axis. Returns all grains if there are fewer than 100.
std::vector<Ball> visibleGrains(const std::vector<base::Vec3f>& positions, const std::vector<float>& radii);

/// Whether the parts extend in the horizontal plane only, e.g. a mechanism that moves along x and y.
bool liesFlat(const std::vector<base::Vec3f>& vertices);

/// Camera in which the parts fill the picture; their farthest corners may be outside.
Camera cameraOnParts(const std::vector<base::Vec3f>& vertices, double azimuth, double elevation, double aspect);

/// Picture of a frame, seen from the front right above: grains coloured by height, parts by kind. The vehicle fills the
/// picture, or else all grains except distant ones. Aspect ratio 16:9. `labels`: time, height scale of the grains, and
/// a scale bar at the distance of the camera's target; no labels in pictures narrower than kNarrowestLabelled.
Image drawFrame(const output::Frame& frame, const std::vector<output::FramePart>& parts,
                const base::TriangleMesh& ground, int width, bool labels = true);
inline constexpr int kNarrowestLabelled = 480; // [pixels]

} // namespace grouser::render

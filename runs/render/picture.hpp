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

/// The grains of a picture of the bed, without strays: grains whose distance from the middle 98 % of the grains on any
/// axis exceeds the width of these; none with less than 100 grains.
std::vector<Ball> seenGrains(const std::vector<base::Vec3f>& positions, const std::vector<float>& radii);

/// Whether parts spread in the horizontal plane only, as a mechanism that moves in x and y does.
bool liesFlat(const std::vector<base::Vec3f>& vertices);

/// A camera filled by the parts; their farthest corners may be outside.
Camera cameraOnParts(const std::vector<base::Vec3f>& vertices, double azimuth, double elevation, double aspect);

/// Picture of a frame: grains coloured by height, parts by kind, filled by the vehicle or else by all grains except
/// strays; seen from the front right above. Aspect ratio 16:9. `labels`: time, height scale of the grains, and a scale
/// bar at the distance of the camera's target; none in pictures narrower than kNarrowestLabelled.
Image drawFrame(const output::Frame& frame, const std::vector<output::FramePart>& parts,
                const base::TriangleMesh& ground, int width, bool labels = true);
inline constexpr int kNarrowestLabelled = 480; // [pixels]

} // namespace grouser::render

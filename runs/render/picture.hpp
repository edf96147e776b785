// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"
#include "runs/render/image.hpp"
#include "runs/render/render.hpp"

namespace grouser::render {

/// Elevation of the camera above a vehicle, above a bed alone, and above parts that lie flat [deg].
inline constexpr double kVehicleElevation = 14, kBedElevation = 30, kFlatElevation = 60;
inline constexpr double kAzimuth = -55; ///< of the camera about z [deg]
/// The same above a vehicle on deformable soil, from behind, so that its ruts are seen; and how much farther away.
inline constexpr double kRutElevation = 24, kRutAzimuth = -140, kRutDistance = 1.3;

Colour partColour(output::PartKind kind);

/// The grains that a picture of the bed shows: all, but for strays. Strays lie farther from the middle 98 % of the
/// grains, axis by axis, than these are wide; of less than 100 grains none.
std::vector<Ball> seenGrains(const std::vector<base::Vec3f>& positions, const std::vector<float>& radii);

/// Whether parts spread in the horizontal plane only, as a mechanism that moves in x and y does.
bool liesFlat(const std::vector<base::Vec3f>& vertices);

/// A camera whose picture the parts fill; their farthest corners may lie outside.
Camera cameraOnParts(const std::vector<base::Vec3f>& vertices, double azimuth, double elevation, double aspect);

/// A frame as one looks at it: grains coloured by height, parts by kind, the vehicle filling the picture, or where
/// there is none all grains but a few strays; seen from the front right above. Height of the picture: nine sixteenths
/// of its width. With `labels` its time, the scale of the grains' heights, and a bar of a round length as it is seen at
/// the distance of what the camera looks at. Pictures narrower than kNarrowestLabelled have none of it, nor where the
/// font is missing.
Image drawFrame(const output::Frame& frame, const std::vector<output::FramePart>& parts,
                const base::TriangleMesh& ground, int width, bool labels = true);
inline constexpr int kNarrowestLabelled = 480; // [pixels]

} // namespace grouser::render

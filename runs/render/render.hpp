// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/render/image.hpp"
#include "runs/render/render_scene.hpp"

#include <vector>

/// Software renderer without GPU, display or library: spheres and meshes in a depth buffer, then light, shadow and
/// ambient occlusion. For viewing, not for measurements.
namespace grouser::render {

struct Camera {
  base::Vec3d eye{5, -5, 3}, target, up{0, 0, 1}; ///< [m]
  double fieldOfView = 35;                        ///< vertical [deg]
};

/// Camera that shows the whole sphere, from `azimuth` [deg] about z (0 along +x) and `elevation` [deg] above the
/// horizon.
Camera cameraTowards(const base::Vec3d& centre, double radius, double azimuth, double elevation, double aspect);

struct Ball {
  base::Vec3d centre; ///< [m]
  double radius{};    ///< [m]
};

/// Nearest camera that targets the middle of `balls` and shows all of them with a margin. `balls` must not be empty.
Camera cameraAround(const std::vector<Ball>& balls, double azimuth, double elevation, double aspect);

/// Picture of the scene as seen by the camera, with four samples per pixel.
Image render(const RenderScene& scene, const Camera& camera, int width, int height);

} // namespace grouser::render

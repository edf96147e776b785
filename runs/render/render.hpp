// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/render/image.hpp"
#include "runs/render/render_scene.hpp"

#include <vector>

/// Pictures without a GPU, a display or a library: spheres and meshes into a depth buffer, then light, shadow and
/// ambient occlusion. For looking at a result, not for measuring it.
namespace grouser::render {

struct Camera {
  base::Vec3d eye{5, -5, 3}, target, up{0, 0, 1}; ///< [m]
  double fieldOfView = 35;                        ///< vertical [deg]
};

/// A camera that sees the sphere about `centre` of `radius` whole, from `azimuth` [deg] about z (0 is +x) and
/// `elevation` [deg] above the horizon.
Camera cameraTowards(const base::Vec3d& centre, double radius, double azimuth, double elevation, double aspect);

struct Ball {
  base::Vec3d centre; ///< [m]
  double radius{};    ///< [m]
};

/// The nearest camera that looks at the middle of `balls` and sees each of them whole, with a margin. `balls` must not
/// be empty.
Camera cameraAround(const std::vector<Ball>& balls, double azimuth, double elevation, double aspect);

/// The scene as seen by the camera, four samples a pixel.
Image render(const RenderScene& scene, const Camera& camera, int width, int height);

} // namespace grouser::render

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "base/vec.hpp"
#include "runs/render/image.hpp"

#include <array>
#include <cstdint>
#include <vector>

/// Pictures without a GPU, a display or a library: spheres and meshes into a depth buffer, then light, shadow and
/// ambient occlusion. For looking at a result, not for measuring it.
namespace grouser::render {

/// Linear colour, each 0 to 1.
using Colour = base::Vec3f;

/// Linear colour of an sRGB triple 0 to 255.
Colour srgb(int red, int green, int blue);
/// The sRGB triple of a linear colour.
std::array<std::uint8_t, 3> toSrgb(const Colour& colour);

/// A perceptually even colour map from dark violet over green to yellow; `value` 0 to 1, clamped.
Colour heightColour(float value);

struct RenderSphere {
  base::Vec3f centre; ///< [m]
  float radius{};     ///< [m]
  Colour colour;
};

struct RenderMesh {
  base::TriangleMesh mesh;
  base::Pose pose; ///< X_WB
  Colour colour;
  bool oneSided = false; ///< not seen from behind: a container's near wall does not hide what is in it
};

struct RenderScene {
  std::vector<RenderSphere> spheres;
  std::vector<RenderMesh> meshes;
};

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

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/render.hpp"

#include "base/math.hpp"
#include "runs/render/detail/raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace grouser::render {

using base::Vec3d;
using base::Vec3f;
using detail::Surfaces;
using detail::View;

namespace {

constexpr int kSubpixels = 2; ///< number of samples per pixel and axis
constexpr int kShadowPixels = 2048;
constexpr int kOcclusionTaps = 16;
constexpr float kNear = 0.002f;                          ///< near plane / distance of the target
constexpr double kMargin = 1.1;                          ///< margin around the visible objects
constexpr double kSunAzimuth = -100, kSunElevation = 50; ///< [deg]
const Colour kSun{1.00f, 0.95f, 0.86f}, kSky{0.52f, 0.62f, 0.75f}, kEarth{0.30f, 0.27f, 0.24f};
constexpr float kUnknown = -1;                                     ///< openness of pixels without a sample
constexpr float kNothing = std::numeric_limits<float>::infinity(); ///< depth of empty pixels
const Colour kHorizon{0.90f, 0.92f, 0.94f}, kZenith{0.55f, 0.68f, 0.82f};

Vec3d direction(double azimuth, double elevation) {
  const double a = azimuth * base::kPi / 180, e = elevation * base::kPi / 180;
  return {base::cos(a) * base::cos(e), base::sin(a) * base::cos(e), base::sin(e)};
}

Ball around(const RenderScene& scene) {
  Vec3d low{1e300, 1e300, 1e300}, high = low * -1.0;
  const auto take = [&](const Vec3d& p) { low = base::min(low, p), high = base::max(high, p); };
  for (const RenderSphere& s : scene.spheres) {
    const Vec3d reach{s.radius, s.radius, s.radius};
    take(s.centre.as<double>() - reach), take(s.centre.as<double>() + reach);
  }
  for (const RenderMesh& m : scene.meshes)
    for (const Vec3d& v : m.mesh.vertices) take(m.pose.toWorld(v));
  if (low.x > high.x) return {{}, 1};
  return {(low + high) * 0.5, 0.5 * norm(high - low) * 1.001};
}

/// Shadow map: the scene from the sun, restricted to the part visible to the camera for maximum resolution.
Surfaces sunView(const RenderScene& scene, const std::vector<detail::Facet>& facets, const Ball& ball,
                 const Surfaces& seen) {
  View v = detail::viewTowards(ball.centre + direction(kSunAzimuth, kSunElevation) * (2 * ball.radius), ball.centre,
                               {0, 0, 1});
  v.perspective = false, v.width = v.height = kShadowPixels;
  Vec3f low{1e30f, 1e30f, 0}, high = -low;
  for (int row = 0; row < seen.view.height; row += kSubpixels)
    for (int column = 0; column < seen.view.width; column += kSubpixels) {
      const std::size_t i = seen.index(column, row);
      if (seen.object[i] < 0) continue;
      const Vec3f p = v.toCamera(seen.view.toWorld(seen.view.at(column, row, seen.depth[i])));
      low = base::min(low, p), high = base::max(high, p);
    }
  v.halfHeight = static_cast<float>(ball.radius);
  if (low.x <= high.x) {
    const Vec3f middle = (low + high) * 0.5f;
    v.eye += v.right * middle.x + v.up * middle.y;
    // Margin for the neighbouring texels of a shadow lookup.
    v.halfHeight = std::min(v.halfHeight, 0.51f * std::max(high.x - low.x, high.y - low.y) + 1e-6f);
  }
  Surfaces s(v);
  detail::rasterise(scene.spheres, facets, s);
  return s;
}

/// Fraction of sunlight at a point: nine samples of the shadow map.
float sunlit(const Surfaces& sun, const Vec3f& p_W, const Vec3f& normal) {
  const View& v = sun.view;
  const float texel = 2 * v.halfHeight / float(kShadowPixels);
  const Vec3f p = v.toCamera(p_W + normal * (2.0f * texel));
  const int column = static_cast<int>((p.x / v.halfHeight + 1) * 0.5f * float(kShadowPixels));
  const int row = static_cast<int>((1 - p.y / v.halfHeight) * 0.5f * float(kShadowPixels));
  int seen = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = std::clamp(column + dx, 0, kShadowPixels - 1), y = std::clamp(row + dy, 0, kShadowPixels - 1);
      seen += p.z <= sun.depth[sun.index(x, y)] + 1.5f * texel;
    }
  return static_cast<float>(seen) / 9;
}

/// Sample offsets on the unit disc: a spiral, rotated by one of 16 angles in a 4 x 4 pattern of pixels.
std::array<std::array<float, 2>, kOcclusionTaps> spiral(int turn) {
  std::array<std::array<float, 2>, kOcclusionTaps> taps;
  for (int k = 0; k < kOcclusionTaps; ++k) {
    const double r = (k + 0.5) / kOcclusionTaps, angle = 2.399963 * k + 2 * base::kPi * turn / 16;
    taps[static_cast<std::size_t>(k)] = {static_cast<float>(r * base::cos(angle)),
                                         static_cast<float>(r * base::sin(angle))};
  }
  return taps;
}

/// Rounds |x| < 8192; much cheaper than lround.
int nearestInt(float x) { return static_cast<int>(x + 8192.5f) - 8192; }

/// Openness of each pixel (ambient occlusion), 0 to 1, from the depth buffer: reduced by neighbours within `reach` [m]
/// above the tangent plane. Every second pixel in a chessboard pattern; kUnknown elsewhere.
std::vector<float> openness(const Surfaces& s, float reach) {
  std::array<std::array<std::array<float, 2>, kOcclusionTaps>, 16> patterns;
  for (int turn = 0; turn < 16; ++turn) patterns[static_cast<std::size_t>(turn)] = spiral(turn * 7 % 16);
  std::vector<float> open(s.depth.size(), kUnknown);
#pragma omp parallel for schedule(dynamic, 16)
  for (int row = 0; row < s.view.height; ++row)
    for (int column = 0; column < s.view.width; ++column) {
      const std::size_t i = s.index(column, row);
      if (s.object[i] < 0 || (row + column) % 2) continue;
      const Vec3f p = s.view.at(column, row, s.depth[i]), n = s.view.toCameraFrame(s.normalAt(i));
      const float pixels = std::clamp(reach * s.view.pixelsPerUnit() / s.depth[i], 2.0f, 200.0f);
      float closed = 0;
      for (const auto& tap : patterns[static_cast<std::size_t>(row % 4 * 4 + column % 4)]) {
        const int x = column + nearestInt(tap[0] * pixels), y = row + nearestInt(tap[1] * pixels);
        if (x < 0 || y < 0 || x >= s.view.width || y >= s.view.height) continue;
        const float depth = s.depth[s.index(x, y)];
        if (depth == kNothing) continue;
        const Vec3f d = s.view.at(x, y, depth) - p;
        const float d2 = dot(d, d) + 1e-12f;
        closed += std::max(0.0f, dot(d, n) / std::sqrt(d2) - 0.1f) / (1 + d2 / (reach * reach));
      }
      open[i] = std::max(0.0f, 1 - 2.2f * closed / kOcclusionTaps);
    }
  return open;
}

/// Mean over the 4 x 4 pattern, including only pixels of similar depth.
float smoothed(const Surfaces& s, const std::vector<float>& open, int column, int row, float reach) {
  const float depth = s.depth[s.index(column, row)];
  float sum = 0, count = 0;
  for (int y = std::max(0, row - 2); y < std::min(s.view.height, row + 2); ++y)
    for (int x = std::max(0, column - 2); x < std::min(s.view.width, column + 2); ++x) {
      const std::size_t i = s.index(x, y);
      if (open[i] == kUnknown || std::fabs(s.depth[i] - depth) > 0.5f * reach) continue;
      sum += open[i], count += 1;
    }
  return count > 0 ? sum / count : 1;
}

Colour times(const Colour& a, const Colour& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

Colour shade(const Colour& surface, const Vec3f& normal, const Vec3f& towardsEye, float sun, float open) {
  const Vec3f light = direction(kSunAzimuth, kSunElevation).as<float>();
  const float facing = std::max(0.0f, dot(normal, light)) * sun;
  const float sky = 0.5f + 0.5f * normal.z;
  Colour c = times(surface,
                   kSun * (1.2f * facing * (0.6f + 0.4f * open)) + (kSky * sky + kEarth * (1 - sky)) * (0.75f * open));
  const Vec3f half = normalized(light + towardsEye);
  const float gloss = std::max(0.0f, dot(normal, half));
  const float g4 = gloss * gloss * gloss * gloss, g16 = g4 * g4 * g4 * g4;
  c += kSun * (0.06f * g16 * sun);
  return c;
}

Colour background(int row, int height) {
  const float t = static_cast<float>(row) / static_cast<float>(height);
  return kZenith * (1 - t) + kHorizon * t;
}

/// Reach of ambient occlusion: a few grain radii, or a fraction of the visible size.
float occlusionReach(const RenderScene& scene, const Ball& ball) {
  float grain = 0;
  for (const RenderSphere& s : scene.spheres) grain = std::max(grain, s.radius);
  return std::max(3 * grain, 0.02f * static_cast<float>(ball.radius));
}

} // namespace

Camera cameraTowards(const Vec3d& centre, double radius, double azimuth, double elevation, double aspect) {
  Camera camera;
  const double half = 0.5 * camera.fieldOfView * base::kPi / 180;
  const double narrow = aspect < 1 ? base::atan(base::tan(half) * aspect) : half;
  camera.target = centre;
  camera.eye = centre + direction(azimuth, elevation) * (radius / base::sin(narrow));
  return camera;
}

Camera cameraAround(const std::vector<Ball>& balls, double azimuth, double elevation, double aspect) {
  Camera camera;
  Vec3d low{1e300, 1e300, 1e300}, high = -low;
  for (const Ball& b : balls) {
    const Vec3d reach{b.radius, b.radius, b.radius};
    low = base::min(low, b.centre - reach), high = base::max(high, b.centre + reach);
  }
  const Vec3d towardsEye = direction(azimuth, elevation);
  const Vec3d right = normalized(cross(camera.up, towardsEye)), up = cross(towardsEye, right);
  const double tanUp = base::tan(0.5 * camera.fieldOfView * base::kPi / 180) / kMargin, tanRight = tanUp * aspect;
  camera.target = (low + high) * 0.5;
  // A ball at (x, z), z towards the eye, is within the half angle a of an eye at distance d if
  // |x| cos a + r <= (d - z) sin a.
  double distance = 0;
  for (const Ball& b : balls) {
    const Vec3d p = b.centre - camera.target;
    for (const auto& [x, tangent] : {std::pair{dot(p, right), tanRight}, std::pair{dot(p, up), tanUp}})
      distance = std::max(distance,
                          dot(p, towardsEye) + (std::fabs(x) + b.radius * std::sqrt(1 + tangent * tangent)) / tangent);
  }
  camera.eye = camera.target + towardsEye * distance;
  return camera;
}

Image render(const RenderScene& scene, const Camera& camera, int width, int height) {
  const std::vector<detail::Facet> facets = detail::facetsOf(scene);
  const Ball ball = around(scene);
  View view = detail::viewTowards(camera.eye, camera.target, camera.up);
  view.halfHeight = static_cast<float>(base::tan(0.5 * camera.fieldOfView * base::kPi / 180));
  view.near = kNear * static_cast<float>(norm(camera.target - camera.eye));
  view.width = kSubpixels * width, view.height = kSubpixels * height;
  Surfaces seen(view);
  detail::rasterise(scene.spheres, facets, seen);
  const Surfaces sun = sunView(scene, facets, ball, seen);
  const float reach = occlusionReach(scene, ball);
  const std::vector<float> open = openness(seen, reach);

  const auto sample = [&](int column, int row) {
    const std::size_t i = seen.index(column, row);
    if (seen.object[i] < 0) return background(row, view.height);
    const std::size_t object = static_cast<std::size_t>(seen.object[i]), spheres = scene.spheres.size();
    const bool coloured = object >= spheres && !scene.meshes[object - spheres].vertexColours.empty();
    const Colour& colour = object < spheres ? scene.spheres[object].colour
                           : coloured       ? seen.colour[i]
                                            : scene.meshes[object - spheres].colour;
    const Vec3f p = view.toWorld(view.at(column, row, seen.depth[i])), n = seen.normalAt(i);
    return shade(colour, n, normalized(view.eye - p), sunlit(sun, p, n), smoothed(seen, open, column, row, reach));
  };
  Image image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3)};
#pragma omp parallel for schedule(dynamic, 8)
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      Colour sum;
      for (int k = 0; k < kSubpixels * kSubpixels; ++k)
        sum += sample(kSubpixels * column + k % kSubpixels, kSubpixels * row + k / kSubpixels);
      const std::array<std::uint8_t, 3> rgb = toSrgb(sum * (1.0f / (kSubpixels * kSubpixels)));
      std::copy(rgb.begin(), rgb.end(), image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(row) * width + column));
    }
  return image;
}

} // namespace grouser::render

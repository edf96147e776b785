// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/picture.hpp"

#include "base/math.hpp"
#include "runs/render/ground_colours.hpp"
#include "runs/render/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace grouser::render {

using base::Vec3d;

namespace {

constexpr double kVehicleTight = 0.8; ///< visible fraction of the bounding sphere
constexpr double kWholeBed = 2.6;     ///< ratio of camera distances up to which the picture shows the whole bed
constexpr double kBackground = 6;     ///< size ratio above which the camera ignores a surface as background
constexpr double kFlat = 0.2;         ///< maximum height / radius of flat parts [-]
constexpr double kAspect = 16.0 / 9;
constexpr int kScaleColours = 256;

struct Box {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void take(const Vec3d& p) { low = base::min(low, p), high = base::max(high, p); }
  Vec3d middle() const { return (low + high) * 0.5; }
  double radius() const { return 0.5 * norm(high - low); }
};

} // namespace

Colour partColour(output::PartKind kind) {
  using Kind = output::PartKind;
  struct Painted {
    Kind kind;
    Colour colour;
  };
  const Painted kPainted[] = {
      {Kind::chassis, srgb(112, 122, 92)},    {Kind::shoe, srgb(66, 68, 72)},      {Kind::sprocket, srgb(214, 138, 48)},
      {Kind::roadWheel, srgb(122, 146, 176)}, {Kind::roller, srgb(150, 172, 150)}, {Kind::idler, srgb(178, 96, 84)},
      {Kind::surface, groundColour()},        {Kind::body0, srgb(78, 121, 167)},   {Kind::body1, srgb(214, 138, 48)},
      {Kind::body2, srgb(89, 161, 79)},       {Kind::body3, srgb(178, 96, 84)},    {Kind::body4, srgb(140, 110, 160)},
      {Kind::body5, srgb(118, 183, 178)},
  };
  for (const Painted& painted : kPainted)
    if (painted.kind == kind) return painted.colour;
  return srgb(150, 150, 150);
}

namespace {

/// Colour of grains or fluid particles at a position in the range of heights, 0 to 1.
Colour grainColour(const output::Frame& frame, float place) {
  return frame.fluid ? heightColour(place) : soilColour(place);
}

/// Lowest height and range of the colours, without the lowest and highest hundredth, so that single thrown grains have
/// no effect.
std::pair<float, float> heightScale(const output::Frame& frame) {
  std::vector<float> heights;
  for (const base::Vec3f& p : frame.positions) heights.push_back(p.z);
  std::sort(heights.begin(), heights.end());
  const std::size_t cut = heights.size() / 100;
  return {heights[cut], std::max(heights[heights.size() - 1 - cut] - heights[cut], frame.radii.front())};
}

} // namespace

std::vector<Ball> visibleGrains(const std::vector<base::Vec3f>& positions, const std::vector<float>& radii) {
  const std::size_t count = positions.size(), cut = count / 100;
  Vec3d low, high;
  for (int k = 0; k < 3; ++k) {
    std::vector<float> places;
    for (const base::Vec3f& p : positions) places.push_back(p[k]);
    std::sort(places.begin(), places.end());
    low[k] = places[cut], high[k] = places[count - 1 - cut];
  }
  const Vec3d reach = high - low + Vec3d{1, 1, 1} * (2.0 * radii.front());
  std::vector<Ball> balls;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d p = positions[i].as<double>();
    if (cut == 0 || (base::min(p, low - reach) == low - reach && base::max(p, high + reach) == high + reach))
      balls.push_back({p, radii[i]});
  }
  return balls;
}

bool liesFlat(const std::vector<base::Vec3f>& vertices) {
  Box box;
  for (const base::Vec3f& p : vertices) box.take(p.as<double>());
  return box.high.z - box.low.z < kFlat * box.radius();
}

Camera cameraOnParts(const std::vector<base::Vec3f>& vertices, double azimuth, double elevation, double aspect) {
  Box box;
  for (const base::Vec3f& v : vertices) box.take(v.as<double>());
  return cameraTowards(box.middle(), std::max(1e-3, box.radius()) * kVehicleTight, azimuth, elevation, aspect);
}

namespace {

/// Adds the corners of surfaces that are not background, starting with the smallest surface.
std::vector<Ball> withSurfaces(std::vector<Ball> seen, std::vector<std::vector<Vec3d>> surfaces) {
  const auto radiusOf = [](const std::vector<Vec3d>& corners) {
    Box box;
    for (const Vec3d& p : corners) box.take(p);
    return box.radius();
  };
  Box all;
  for (const Ball& ball : seen)
    for (const double side : {-ball.radius, ball.radius}) all.take(ball.centre + Vec3d{side, side, side});
  std::sort(surfaces.begin(), surfaces.end(), [&](const auto& a, const auto& b) { return radiusOf(a) < radiusOf(b); });
  for (const std::vector<Vec3d>& corners : surfaces) {
    if (!seen.empty() && radiusOf(corners) > kBackground * all.radius()) break;
    for (const Vec3d& p : corners) seen.push_back({p, 0}), all.take(p);
  }
  return seen;
}

/// Corners of the bounding box of a mesh.
std::vector<Ball> cornersOf(const base::TriangleMesh& mesh) {
  Box box;
  for (const Vec3d& v : mesh.vertices) box.take(v);
  std::vector<Ball> corners;
  for (const double x : {box.low.x, box.high.x})
    for (const double y : {box.low.y, box.high.y})
      for (const double z : {box.low.z, box.high.z}) corners.push_back({{x, y, z}, 0});
  return corners;
}

struct Drawn {
  Image image;
  Camera camera;
};

Drawn drawn(const output::Frame& frame, const std::vector<output::FramePart>& parts, const base::TriangleMesh& ground,
            int width) {
  RenderScene scene;
  std::vector<base::Vec3f> vehicle;
  std::vector<std::vector<Vec3d>> surfaces;
  if (!ground.vertices.empty()) surfaces.push_back(ground.vertices);
  if (!frame.positions.empty()) {
    const auto [low, range] = heightScale(frame);
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      const base::Vec3f& p = frame.positions[i];
      scene.spheres.push_back({p, frame.radii[i], grainColour(frame, (p.z - low) / range)});
    }
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // Rigid surfaces are visible only from the side that faces grains.
    const bool surface = parts[i].kind == output::PartKind::surface;
    scene.meshes.push_back({parts[i].mesh, frame.partPoses[i], partColour(parts[i].kind), surface, {}});
    std::vector<Vec3d> corners;
    for (const Vec3d& v : parts[i].mesh.vertices) corners.push_back(frame.partPoses[i].toWorld(v));
    if (surface)
      surfaces.push_back(std::move(corners));
    else
      for (const Vec3d& v : corners) vehicle.push_back(v.as<float>());
  }
  if (frame.soil)
    scene.meshes.push_back(GroundColours().mesh(*frame.soil));
  else if (!ground.indices.empty())
    scene.meshes.push_back({ground, {}, groundColour(), false, {}});
  Camera camera;
  std::vector<Ball> seen;
  if (!frame.positions.empty()) seen = visibleGrains(frame.positions, frame.radii);
  if (!vehicle.empty()) {
    if (frame.soil) seen = cornersOf(scene.meshes.back().mesh);
    const double azimuth = frame.soil ? kRutAzimuth : kAzimuth;
    const double elevation = frame.soil ? kRutElevation : liesFlat(vehicle) ? kFlatElevation : kVehicleElevation;
    camera = cameraOnParts(vehicle, azimuth, elevation, kAspect);
    if (frame.soil) camera.eye = camera.target + (camera.eye - camera.target) * kRutDistance;
    // The picture shows a bed of a few vehicle lengths completely; a larger bed fills the picture.
    if (!seen.empty()) {
      for (const base::Vec3f& v : vehicle) seen.push_back({v.as<double>(), 0});
      const Camera whole = cameraAround(seen, azimuth, elevation, kAspect);
      if (norm(whole.eye - whole.target) < kWholeBed * norm(camera.eye - camera.target)) camera = whole;
    }
  } else if (seen = withSurfaces(std::move(seen), std::move(surfaces)); !seen.empty()) {
    camera = cameraAround(seen, kAzimuth, kBedElevation, kAspect);
  }
  return {render(scene, camera, width, std::max(1, width * 9 / 16)), camera};
}

} // namespace

Image drawFrame(const output::Frame& frame, const std::vector<output::FramePart>& parts,
                const base::TriangleMesh& ground, int width, bool labels) {
  auto [image, camera] = drawn(frame, parts, ground, width);
  if (!labels || width < kNarrowestLabelled) return image;
  const Font font;
  drawCaption(image, font, fmt::format("t = {:.4g} s", frame.time));
  if (!frame.positions.empty()) {
    const auto [low, range] = heightScale(frame);
    std::vector<Colour> colours;
    for (int i = 0; i < kScaleColours; ++i)
      colours.push_back(grainColour(frame, static_cast<float>(i) / static_cast<float>(kScaleColours - 1)));
    drawScale(image, font, frame.fluid ? "fluid: z [m]" : "grains: z [m]", double{low}, double{low + range}, colours);
  }
  const double distance = norm(camera.eye - camera.target);
  drawLength(image, font, image.height / (2 * distance * base::tan(0.5 * camera.fieldOfView * base::kPi / 180)));
  return image;
}

} // namespace grouser::render

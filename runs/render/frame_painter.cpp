// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/frame_painter.hpp"

#include "base/error.hpp"
#include "runs/render/picture.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::render {

using base::Vec3d;

namespace {

constexpr std::size_t kSamples = 8; ///< sampled frames for colour range and camera
constexpr double kSteepest = 89.99; ///< maximum elevation [deg]; at 90 the up direction is undefined

/// Evenly spaced frames, including the first and the last.
std::vector<output::StoredFrame> samplesOf(const output::FramesReader& reader) {
  const std::size_t count = std::min(kSamples, reader.count());
  std::vector<output::StoredFrame> samples;
  for (std::size_t k = 0; k < count; ++k)
    samples.push_back(reader.read(count == 1 ? 0 : k * (reader.count() - 1) / (count - 1)));
  return samples;
}

/// Blends a picture of the ground with the complete picture.
void blend(Image& all, const Image& ground) {
  constexpr int kVehiclePercent = 30;
  for (std::size_t k = 0; k < all.rgb.size(); ++k)
    all.rgb[k] =
        static_cast<std::uint8_t>((kVehiclePercent * all.rgb[k] + (100 - kVehiclePercent) * ground.rgb[k]) / 100);
}

} // namespace

FramePainter::FramePainter(const output::FramesReader& reader, const PaintOptions& options)
    : reader_(reader), options_(options) {
  if (options.labels) font_ = std::make_unique<Font>();
  const std::vector<output::StoredFrame> samples = samplesOf(reader);
  ground_ = GroundColours(options.ground, samples, options.range);
  if (ground_.hasRange() && std::none_of(samples.begin(), samples.end(), [](const auto& f) { return bool(f.soil); }))
    throw base::InputError(fmt::format(
        "{}: contains no deformable soil (terrain.kind = \"scm\"); use --color depth, speed, subdomain, role or white",
        reader.path().string()));
  colours_ = std::make_unique<GrainColours>(options.quantity, samples.front(), samples, options.range);
  const bool needsBorders = options.quantity == GrainQuantity::Subdomain || options.quantity == GrainQuantity::Role;
  const auto hasBorders = [](const Borders& b) { return !b[0].empty() || !b[1].empty() || !b[2].empty(); };
  if (needsBorders && !hasBorders(options.borders) &&
      std::none_of(samples.begin(), samples.end(), [&](const output::StoredFrame& f) { return hasBorders(f.borders); }))
    throw base::InputError(
        fmt::format("{}: the run had a single subdomain; set --borders AXIS=POSITIONS, e.g. x=0.5, or another --color",
                    reader.path().string()));
  placeCamera(samples);
}

Vec3d FramePainter::hull(const output::StoredFrame& frame) const {
  Vec3d sum;
  double count = 0;
  for (const output::StoredPart& part : reader_.parts()) {
    if (part.kind != output::PartKind::chassis) continue;
    for (std::uint32_t v = 0; v < part.count; ++v) sum += frame.partVertices[part.first + v].as<double>(), count += 1;
  }
  return count > 0 ? sum * (1 / count) : sum;
}

void FramePainter::placeCamera(const std::vector<output::StoredFrame>& samples) {
  const FrameView& view = options_.view;
  const double aspect = static_cast<double>(view.width) / view.height;
  const bool isClose = view.lookAt == LookAt::Vehicle;
  std::vector<Ball> all;
  for (const output::StoredFrame& frame : samples) {
    for (const base::Vec3f& v : frame.partVertices) all.push_back({v.as<double>(), 0});
    if (!frame.positions.empty())
      for (const Ball& ball : visibleGrains(frame.positions, frame.radii)) all.push_back(ball);
  }
  for (const Vec3d& v : reader_.ground().vertices) all.push_back({v, 0});
  const bool isMechanism = !samples.front().partVertices.empty() && samples.front().positions.empty();
  const bool hasRuts = isClose && samples.front().soil;
  const double azimuth = view.azimuth.value_or(hasRuts ? kRutAzimuth : kAzimuth);
  const double usual = hasRuts                                                 ? kRutElevation
                       : isMechanism && liesFlat(samples.front().partVertices) ? kFlatElevation
                       : isClose || isMechanism                                ? kVehicleElevation
                                                                               : kBedElevation;
  const double elevation = std::clamp(view.elevation.value_or(usual), -kSteepest, kSteepest);
  if (isClose) {
    if (!reader_.hasVehicle())
      throw base::InputError(fmt::format("{}: contains no vehicle; use --look-at all", reader_.path().string()));
    camera_ = cameraOnParts(samples.front().partVertices, azimuth, elevation, aspect);
    if (hasRuts) camera_.eye = camera_.target + (camera_.eye - camera_.target) * kRutDistance;
    hullAtCamera_ = hull(samples.front());
  } else if (!all.empty()) {
    camera_ = cameraAround(all, azimuth, elevation, aspect);
  }
  Vec3d towardsEye = camera_.eye - camera_.target;
  if (view.distance) towardsEye = normalized(towardsEye) * *view.distance;
  if (view.lookAt == LookAt::Point) camera_.target = view.point;
  camera_.eye = camera_.target + towardsEye;
}

Camera FramePainter::cameraOf(const output::StoredFrame& frame) const {
  Camera camera = camera_;
  if (hullAtCamera_) {
    const Vec3d moved = hull(frame) - *hullAtCamera_;
    camera.eye += moved, camera.target += moved;
  }
  return camera;
}

const Borders& FramePainter::bordersOf(const output::StoredFrame& frame) const {
  for (const std::vector<double>& places : options_.borders)
    if (!places.empty()) return options_.borders;
  return frame.borders;
}

Image FramePainter::paint(std::size_t index) const {
  const output::StoredFrame frame = reader_.read(index);
  const Borders& borders = bordersOf(frame);
  const std::vector<Colour> colours = colours_->of(frame, borders);
  RenderScene scene;
  scene.spheres.reserve(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i)
    scene.spheres.push_back({frame.positions[i], frame.radii[i], colours[i]});
  for (const output::StoredPart& part : reader_.parts()) {
    RenderMesh mesh;
    mesh.mesh.indices = part.triangles, mesh.colour = partColour(part.kind);
    mesh.oneSided = part.kind == output::PartKind::surface;
    for (std::uint32_t v = 0; v < part.count; ++v)
      mesh.mesh.vertices.push_back(frame.partVertices[part.first + v].as<double>());
    scene.meshes.push_back(std::move(mesh));
  }
  if (frame.soil)
    scene.meshes.push_back(ground_.mesh(*frame.soil));
  else if (!reader_.ground().indices.empty())
    scene.meshes.push_back({reader_.ground(), {}, groundColour(), true, {}});

  const Camera camera = cameraOf(frame);
  Image image = render(scene, camera, options_.view.width, options_.view.height);
  if (ground_.hasRange() && frame.soil) {
    // The vehicle is transparent, because the stresses act below it.
    scene.meshes.erase(scene.meshes.begin(), scene.meshes.end() - 1);
    blend(image, render(scene, camera, options_.view.width, options_.view.height));
  }
  if (!font_) return image;
  drawCaption(image, *font_, fmt::format("t = {:.3f} s", frame.time));
  if (ground_.hasRange()) {
    std::vector<Colour> scale;
    for (int i = 0; i < 256; ++i) scale.push_back(ground_.scaleColour(i / 255.0));
    drawScale(image, *font_, ground_.title(), ground_.shownRange().low, ground_.shownRange().high, scale);
  }
  if (colours.empty()) return image;
  if (colours_->hasRange()) {
    std::vector<Colour> scale;
    for (int i = 0; i < 256; ++i) scale.push_back(colours_->scaleColour(i / 255.0));
    ValueRange ends = colours_->range();
    // Depth increases downwards.
    if (options_.quantity == GrainQuantity::Depth)
      std::reverse(scale.begin(), scale.end()), std::swap(ends.low, ends.high);
    drawScale(image, *font_, colours_->title(), ends.low, ends.high, scale);
  } else if (const auto legend = colours_->legend(borders); !legend.empty()) {
    drawLegend(image, *font_, colours_->title(), legend);
  }
  return image;
}

} // namespace grouser::render

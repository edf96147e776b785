// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/frames_reader.hpp"
#include "runs/render/ground_colours.hpp"
#include "runs/render/image.hpp"
#include "runs/render/labels.hpp"
#include "runs/render/render.hpp"

#include <memory>
#include <optional>

namespace grouser::render {

enum class LookAt {
  Vehicle, ///< camera follows the hull
  All,     ///< grains, ground and parts of all frames, except a few distant grains
  Point
};

/// Camera and size of the picture.
struct FrameView {
  LookAt lookAt = LookAt::All;
  base::Vec3d point; ///< target of LookAt::Point [m]
  /// Azimuth of the camera about z, from +x [deg]; by default in front of the vehicle, on deformable soil behind it.
  std::optional<double> azimuth;
  /// Elevation of the camera [deg]; empty: low for a vehicle or a mechanism, higher for a bed or flat parts.
  std::optional<double> elevation;
  std::optional<double> distance; ///< distance from the target [m]; empty: fills the picture
  int width = 1600, height = 900;
};

struct PaintOptions {
  FrameView view;
  GrainQuantity quantity = GrainQuantity::Depth;
  GroundQuantity ground = GroundQuantity::Soil; ///< the vehicle is transparent, except with Soil
  std::optional<ValueRange> range;
  Borders borders; ///< borders for files without them
  bool labels = true;
};

/// Renders frames of a file, all with the same colours and the same camera, which is fixed or follows the vehicle. A
/// picture depends only on the file and the options, not on the set of rendered frames or the process.
class FramePainter {
public:
  /// Throws base::InputError if the file lacks the data for these options.
  FramePainter(const output::FramesReader& reader, const PaintOptions& options);

  Image paint(std::size_t index) const;

private:
  void placeCamera(const std::vector<output::StoredFrame>& samples);
  Camera cameraOf(const output::StoredFrame& frame) const;
  /// Centre of the hull in a frame.
  base::Vec3d hull(const output::StoredFrame& frame) const;
  const Borders& bordersOf(const output::StoredFrame& frame) const;

  const output::FramesReader& reader_;
  PaintOptions options_;
  std::unique_ptr<GrainColours> colours_;
  GroundColours ground_;
  std::unique_ptr<Font> font_;
  Camera camera_;                           ///< camera of the first frame
  std::optional<base::Vec3d> hullAtCamera_; ///< hull position [m], if the camera follows the vehicle
};

} // namespace grouser::render

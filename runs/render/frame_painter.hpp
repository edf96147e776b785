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
  Vehicle, ///< moves with its hull
  All,     ///< all grains, ground and parts of all frames, but a few strays
  Point
};

/// From where, at what, how large.
struct FrameView {
  LookAt lookAt = LookAt::All;
  base::Vec3d point; ///< of LookAt::Point [m]
  /// Azimuth of the camera about z, from +x [deg]; by default in front of the vehicle, on deformable soil behind it.
  std::optional<double> azimuth;
  /// Of the camera above the horizon [deg]; empty: low for a vehicle or a mechanism, higher for a bed or what lies
  /// flat.
  std::optional<double> elevation;
  std::optional<double> distance; ///< from what is looked at [m]; empty: so that it fills the picture
  int width = 1600, height = 900;
};

struct PaintOptions {
  FrameView view;
  GrainQuantity quantity = GrainQuantity::Depth;
  GroundQuantity ground = GroundQuantity::Soil; ///< other than Soil: the vehicle is transparent
  std::optional<ValueRange> range;
  Borders borders; ///< where the file has none
  bool labels = true;
};

/// Paints frames of a file, all with the same colours and from the same place, or one that moves with the vehicle.
/// What a picture shows depends on the file and the options alone, not on which frames are painted or by whom.
class FramePainter {
public:
  /// Throws base::InputError where the file cannot show what is asked for.
  FramePainter(const output::FramesReader& reader, const PaintOptions& options);

  Image paint(std::size_t index) const;

private:
  void placeCamera(const std::vector<output::StoredFrame>& samples);
  Camera cameraOf(const output::StoredFrame& frame) const;
  /// The middle of the hull.
  base::Vec3d hull(const output::StoredFrame& frame) const;
  const Borders& bordersOf(const output::StoredFrame& frame) const;

  const output::FramesReader& reader_;
  PaintOptions options_;
  std::unique_ptr<GrainColours> colours_;
  GroundColours ground_;
  std::unique_ptr<Font> font_;
  Camera camera_;                           ///< at the file's first frame
  std::optional<base::Vec3d> hullAtCamera_; ///< [m] where the camera follows
};

} // namespace grouser::render

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/frames_reader.hpp"
#include "runs/render/grain_colours.hpp"
#include "runs/render/render_scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::render {

/// Meaning of the colour of deformable soil.
enum class GroundQuantity {
  Soil,     ///< soil colour, darker where compressed
  Sinkage,  ///< depth below the undisturbed surface [m]
  Pressure, ///< normal pressure on the soil [Pa]
  Shear     ///< magnitude of the shear stress [Pa]
};

/// Parses "sinkage", "pressure" or "shear"; empty for other words.
std::optional<GroundQuantity> groundQuantity(const std::string& word);

/// Colours of deformable soil, equal for all frames.
class GroundColours {
public:
  explicit GroundColours(GroundQuantity quantity = GroundQuantity::Soil) : quantity_(quantity) {}
  /// Colours over `range`; default: from 0, or from the minimum if it is negative, to the maximum of `samples`.
  GroundColours(GroundQuantity quantity, const std::vector<output::StoredFrame>& samples,
                std::optional<ValueRange> range);

  bool hasRange() const { return quantity_ != GroundQuantity::Soil; }
  /// Values at the ends of the colour scale, in the unit of title().
  ValueRange shownRange() const;
  std::string title() const; ///< "pressure [kPa]"
  /// The colour at a position of the range, 0 to 1, for soil of this colour.
  Colour scaleColour(double place, const Colour& soil = groundColour()) const;
  RenderMesh mesh(const output::SoilSurface& soil) const;

private:
  GroundQuantity quantity_;
  ValueRange range_;
};

} // namespace grouser::render

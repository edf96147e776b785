// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/ground_colours.hpp"

#include <algorithm>
#include <utility>

namespace grouser::render {

namespace {

struct Shown {
  const char* word;
  GroundQuantity quantity;
  const char* title;
  double scale;    ///< displayed value / SI value
  double minRange; ///< [m or Pa]
};
constexpr Shown kShown[] = {{"sinkage", GroundQuantity::Sinkage, "sinkage [mm]", 1e3, 1e-6},
                            {"pressure", GroundQuantity::Pressure, "pressure [kPa]", 1e-3, 1},
                            {"shear", GroundQuantity::Shear, "shear [kPa]", 1e-3, 1}};
constexpr double kDarkest = 1e5; ///< maximum pressure at which soil has its darkest colour [Pa]

const Shown& shownOf(GroundQuantity quantity) {
  return *std::find_if(std::begin(kShown), std::end(kShown), [&](const Shown& s) { return s.quantity == quantity; });
}

Colour mixed(const Colour& a, const Colour& b, double share) {
  const auto s = static_cast<float>(std::clamp(share, 0.0, 1.0));
  return a * (1 - s) + b * s;
}

/// [m or Pa]
double valueAt(const output::SoilSurface& soil, GroundQuantity quantity, std::size_t vertex) {
  if (quantity == GroundQuantity::Sinkage) return double{soil.sinkage[vertex]};
  return double{quantity == GroundQuantity::Pressure ? soil.pressure[vertex] : norm(soil.shear[vertex])};
}

} // namespace

std::optional<GroundQuantity> groundQuantity(const std::string& word) {
  for (const Shown& shown : kShown)
    if (word == shown.word) return shown.quantity;
  return {};
}

GroundColours::GroundColours(GroundQuantity quantity, const std::vector<output::StoredFrame>& samples,
                             std::optional<ValueRange> range)
    : quantity_(quantity) {
  if (!hasRange()) return;
  range_ = range.value_or(ValueRange{0, shownOf(quantity).minRange});
  if (range) return;
  for (const output::StoredFrame& frame : samples)
    for (std::size_t v = 0; frame.soil && v < frame.soil->sinkage.size(); ++v) {
      const double value = valueAt(*frame.soil, quantity, v);
      range_ = {std::min(range_.low, value), std::max(range_.high, value)};
    }
}

ValueRange GroundColours::shownRange() const {
  const double scale = shownOf(quantity_).scale;
  return {range_.low * scale, range_.high * scale};
}

std::string GroundColours::title() const { return shownOf(quantity_).title; }

Colour GroundColours::scaleColour(double place, const Colour& soil) const {
  constexpr double kFade = 0.08; // unloaded soil keeps its own colour
  return mixed(soil, heightColour(static_cast<float>(place)), place / kFade);
}

RenderMesh GroundColours::mesh(const output::SoilSurface& soil) const {
  RenderMesh mesh{soil.mesh, {}, groundColour(), true, {}};
  const Colour pressed = srgb(112, 95, 74);
  for (std::size_t v = 0; v < soil.sinkage.size(); ++v) {
    const Colour own = mixed(groundColour(), pressed, double{soil.maxPressure[v]} / kDarkest);
    const double place = hasRange() ? (valueAt(soil, quantity_, v) - range_.low) / (range_.high - range_.low) : 0;
    mesh.vertexColours.push_back(hasRange() ? scaleColour(place, own) : own);
  }
  return mesh;
}

} // namespace grouser::render

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/map_notes.hpp"

#include "base/math.hpp"
#include "runs/setup/scm_setup.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

namespace grouser::setup {

namespace {

/// Heights and pixels of a map on its terrain.
struct Relief {
  double range, meanSlope; ///< highest minus lowest pixel [m]; mean of |grad h| [-]
  bool variesAlongX, variesAlongY;
  double dx, dy;      ///< pixel spacing [m]
  std::size_t levels; ///< number of different heights of an 8-bit map
};

Relief reliefOf(const scene::Terrain& t, const terrain::Heightmap& map) {
  Relief r{};
  r.dx = t.size[0] / (map.columns - 1), r.dy = t.size[1] / (map.rows - 1);
  const double scale = t.heightRange[1] - t.heightRange[0];
  const auto [least, greatest] = std::minmax_element(map.brightness.begin(), map.brightness.end());
  r.range = std::fabs(scale) * (*greatest - *least);
  double sum = 0;
  for (int j = 0; j + 1 < map.rows; ++j)
    for (int i = 0; i + 1 < map.columns; ++i) {
      const double right = map.at(i + 1, j) - map.at(i, j), up = map.at(i, j + 1) - map.at(i, j);
      r.variesAlongX |= right != 0, r.variesAlongY |= up != 0;
      const double hx = scale * right / r.dx, hy = scale * up / r.dy;
      sum += std::sqrt(hx * hx + hy * hy);
    }
  r.meanSlope = sum / (static_cast<double>(map.rows - 1) * (map.columns - 1));
  if (map.bits == 8) r.levels = std::set<double>(map.brightness.begin(), map.brightness.end()).size();
  return r;
}

/// "in millimetres? set height_range = [0, 5]", if such numbers are usual and result in a usual relief; an offset of
/// both heights does not matter.
std::string unitOfHeights(const scene::Terrain& t, const Relief& r, double side) {
  constexpr std::pair<const char*, double> kUnits[] = {{"millimetres", 1e-3}, {"centimetres", 1e-2}};
  constexpr double kLeastNumber = 20, kFlattest = 0.005, kHighest = 0.2, kSteepest = 0.6;
  for (const auto& [name, factor] : kUnits)
    if (r.range >= kLeastNumber && r.range * factor >= kFlattest * side && r.range * factor <= kHighest * side &&
        r.meanSlope * factor <= kSteepest)
      return fmt::format("in {}? set height_range = [{:.6g}, {:.6g}]", name, t.heightRange[0] * factor,
                         t.heightRange[1] * factor);
  return fmt::format("correct height_range or size (usual is a relief of at most {:.2g} m on this size)",
                     kHighest * side);
}

/// A length that steps of the map's heights should be well below, and its name.
std::optional<std::pair<double, std::string>> coarsestStep(const scene::Scene& scene) {
  const scene::Terrain& t = *scene.terrain;
  if (t.granular()) {
    if (!t.grainRadius) return {};
    return std::pair(0.5 * *t.grainRadius, fmt::format("half the grain radius, {:.3g} mm", 500 * *t.grainRadius));
  }
  if (const std::optional<coupling::ScmSetup> soil = scmSetup(scene))
    return std::pair(0.2 * soil->spacing, fmt::format("a fifth of the node spacing, {:.3g} mm", 200 * soil->spacing));
  if (!scene.vehicle) return {};
  const double height = vehicle::readVehicleSpec(scene.vehicle->source()).shoe.grouserHeight;
  if (height <= 0) return {};
  return std::pair(0.5 * height, fmt::format("half the grouser height, {:.3g} mm", 500 * height));
}

} // namespace

std::vector<std::string> mapNotes(const scene::Scene& scene, const terrain::Heightmap& map) {
  constexpr double kMostStretched = 1.5, kSteep = 1;
  constexpr std::size_t kFewLevels = 32; // steps and ditches, which 8 bits represent exactly
  const scene::Terrain& t = *scene.terrain;
  const Relief r = reliefOf(t, map);
  const double side = std::min(t.size[0], t.size[1]);
  std::vector<std::string> notes;
  if (r.range > side || r.meanSlope > kSteep)
    notes.push_back(fmt::format("terrain.height_range = [{:.6g}, {:.6g}] m results in a relief of {:.4g} m with a mean "
                                "slope of {:.0f} degrees on {:.4g} m x {:.4g} m; {}",
                                t.heightRange[0], t.heightRange[1], r.range,
                                base::atan2(r.meanSlope, 1.0) * 180 / base::kPi, t.size[0], t.size[1],
                                unitOfHeights(t, r, side)));
  const double stretch = std::max(r.dx, r.dy) / std::min(r.dx, r.dy);
  if (r.range > 0 && r.variesAlongX && r.variesAlongY && stretch > kMostStretched)
    notes.push_back(fmt::format("terrain.size = [{:.6g}, {:.6g}] m stretches the map of {} x {} pixels by {:.3g} along "
                                "{}; set size to the proportions of the map, e.g. [{:.4g}, {:.4g}], or crop the map",
                                t.size[0], t.size[1], map.columns, map.rows, stretch, r.dx > r.dy ? "x" : "y",
                                t.size[0], t.size[0] * (map.rows - 1) / (map.columns - 1)));
  if (map.bits != 8 || r.levels <= kFewLevels) return notes;
  const double step = std::fabs(t.heightRange[1] - t.heightRange[0]) / 255;
  if (const auto limit = coarsestStep(scene); limit && step > limit->first)
    notes.push_back(fmt::format("terrain.heightmap = {} has 8 bits, so height_range = [{:.6g}, {:.6g}] m results in "
                                "height steps of {:.3g} mm, above {}; save the map with 16 bits, or reduce the range",
                                t.heightmap, t.heightRange[0], t.heightRange[1], 1e3 * step, limit->second));
  return notes;
}

} // namespace grouser::setup

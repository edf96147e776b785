// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/periodic_boundaries.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {

terrain::PeriodicBoundaries periodicBoundaries(const scene::Scene& scene) {
  terrain::PeriodicBoundaries sides;
  const scene::RunSettings& run = scene.run;
  if (run.periodic[0]) {
    if (scene.terrain) sides[0] = {0.0, scene.terrain->size[0]};
    if (run.domainX) sides[0] = *run.domainX;
  }
  if (run.periodic[1]) {
    if (scene.terrain) sides[1] = {-0.5 * scene.terrain->size[1], 0.5 * scene.terrain->size[1]};
    if (run.domainY) sides[1] = *run.domainY;
  }
  return sides;
}

void checkBetweenSides(const scene::Scene& scene, const std::vector<scene::Grain>& grains) {
  const terrain::PeriodicBoundaries sides = periodicBoundaries(scene);
  for (std::size_t a = 0; a < 2; ++a) {
    if (!sides[a]) continue;
    const double from = (*sides[a])[0], to = (*sides[a])[1];
    const int axis = static_cast<int>(a);
    const auto outside = [&](double low, double high) {
      return fmt::format("[m] extends from {} = {:g} to {:g} m, beyond the periodic boundaries at {:g} and {:g} m; "
                         "move it between them, or change run.domain_{}",
                         "xy"[a], low, high, from, to, "xy"[a]);
    };
    for (std::size_t i = 0; i < grains.size(); ++i) {
      const double at = grains[i].position[axis];
      if (at >= from && at < to) continue;
      if (i < scene.grains.size()) scene.fail("grain", i, "position", outside(at, at));
      std::size_t block = 0;
      for (auto last = static_cast<std::int64_t>(scene.grains.size()); block + 1 < scene.fills.size(); ++block)
        if (last += placedCount(scene.fills[block]); static_cast<std::int64_t>(i) < last) break;
      scene.fail("grains", block, scene.fills[block].file ? "file" : at < from ? "low" : "high", outside(at, at));
    }
    for (std::size_t k = 0; k < scene.sources.size(); ++k) {
      const double low = scene.sources[k].low[axis], high = scene.sources[k].high[axis];
      // The box may fill the whole period, since random positions never reach the upper boundary.
      if (!(low >= from && (high < to || (low < high && high <= to))))
        scene.fail("source", k, low < from ? "low" : "high", outside(low, high));
    }
  }
}

void checkSurfacesBetweenSides(const scene::Scene& scene, const ContactPairs& pairs) {
  const terrain::PeriodicBoundaries sides = periodicBoundaries(scene);
  if (!sides[0] && !sides[1]) return;
  for (const SceneSurface& s : pairs.surfaces)
    if (const std::string fault = coupling::faultAtBoundaries(s, s.start, sides, pairs.kinds.largest); !fault.empty())
      scene.fail(s.list(), s.number, "position", "[m]: it " + fault);
}

void checkLevelAcross(const scene::Scene& scene, const terrain::HeightField& surface) {
  const terrain::HeightFieldBounds all = surface.boundsOver(surface.area());
  const double tolerance = 1e-9 * std::max(1.0, std::fabs(all.highest));
  const terrain::Rectangle& area = surface.area();
  constexpr int kSamples = 64;
  for (int axis = 0; axis < 2; ++axis) {
    if (!scene.run.periodic[static_cast<std::size_t>(axis)]) continue;
    for (int along = 0; along <= kSamples; ++along)
      for (int across = 1; across <= kSamples; ++across) {
        const auto height = [&](int k) {
          const double s = static_cast<double>(k) / kSamples, t = static_cast<double>(along) / kSamples;
          return surface.height(area.xMin + (axis == 0 ? s : t) * area.width(),
                                area.yMin + (axis == 0 ? t : s) * area.length());
        };
        if (std::fabs(height(across) - height(0)) <= tolerance) continue;
        scene.fail("run", "periodic",
                   fmt::format("makes the borders along {} periodic, but terrain.heightmap = {} is not level in that "
                               "direction; use a level height-map, or set it to [{}]",
                               "xy"[axis], scene.terrain->heightmap, axis == 0 ? "false, ..." : "..., false"));
      }
  }
}

} // namespace grouser::setup

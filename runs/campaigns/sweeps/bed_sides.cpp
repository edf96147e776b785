// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/bed_sides.hpp"

#include "base/vec.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/scene_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::sweeps {

namespace {

using base::Vec3d;

/// A box along the world's axes [m].
struct Strip {
  Vec3d low, high;
};

/// Region that a wider bed would also fill at one side, extended into the bed by one grain diameter.
Strip besideBed(const scene::Scene& scene, double timesAsWide, bool upper) {
  const scene::Terrain& t = *scene.terrain;
  const terrain::Rectangle area = *setup::terrainArea(scene);
  const double largest = setup::grainKinds(scene).largest, more = 0.5 * (timesAsWide - 1) * area.length();
  // As high above the bed as the bed is deep: loose grains reach higher than settled grains.
  const double thick = t.layers ? *t.layers * *t.spacing * *t.grainRadius : t.depth.value_or(0);
  Strip s{{area.xMin, area.yMin - more, t.heightRange[0] - thick},
          {area.xMax, area.yMin + 2 * largest, t.heightRange[1] + thick}};
  if (upper) s.low.y = area.yMax - 2 * largest, s.high.y = area.yMax + more;
  return s;
}

/// Whether the half-space behind a plane overlaps the strip.
bool meets(const Strip& strip, const scene::Plane& plane) {
  constexpr double kLevel = 1e-9; // y component of the normal [-]
  const Vec3d n = normalized(plane.normal);
  if (std::fabs(n.y) < kLevel) return false;
  double nearest = 0; // signed distance of the farthest corner behind the plane [m]
  for (int axis = 0; axis < 3; ++axis)
    nearest +=
        std::min(n[axis] * (strip.low[axis] - plane.point[axis]), n[axis] * (strip.high[axis] - plane.point[axis]));
  return nearest < 0;
}

bool meets(const Strip& strip, const coupling::SurfaceBounds& box) {
  for (int axis = 0; axis < 3; ++axis)
    if (box.low[axis] >= strip.high[axis] || box.high[axis] <= strip.low[axis]) return false;
  return true;
}

std::string nameOf(const char* list, std::size_t number, const std::optional<std::string>& name) {
  return fmt::format("{} {}{}", list, number, name ? " (" + *name + ")" : "");
}

} // namespace

std::string surfaceAtSides(const scene::Scene& scene, double timesAsWide) {
  const std::vector<setup::SceneSurface> surfaces = setup::surfacesOf(scene);
  for (const bool upper : {false, true}) {
    const Strip strip = besideBed(scene, timesAsWide, upper);
    for (std::size_t k = 0; k < scene.planes.size(); ++k)
      if (!scene.planes[k].aboveBed && meets(strip, scene.planes[k])) return nameOf("plane", k, scene.planes[k].name);
    for (const setup::SceneSurface& s : surfaces)
      if (s.kind != coupling::SurfaceKind::plane && !s.aboveBed && meets(strip, coupling::boundsOf(s, s.start)))
        return nameOf(s.list().c_str(), s.number, s.section.name);
  }
  return "";
}

} // namespace grouser::sweeps

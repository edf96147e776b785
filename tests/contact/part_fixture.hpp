// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "contact/part_motion.hpp"

#include <cmath>

namespace grouser::contact::testing {

/// Upper and lower face of a plate in x-y, cut into spheres of radius r on a square lattice: z = 0 is the upper face.
inline base::SphereSet plate(double halfWidth, double r, double spacing, double thickness = 0.03) {
  base::SphereSet set;
  set.name = "plate";
  set.radius = r, set.spacing = spacing;
  const int n = static_cast<int>(std::floor(2 * (halfWidth - r) / spacing + 1e-9)) + 1;
  const double first = -0.5 * spacing * (n - 1);
  for (const double side : {1.0, -1.0})
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const bool edge = i == 0 || j == 0 || i == n - 1 || j == n - 1;
        base::SetSphere s;
        s.centre = {first + spacing * i, first + spacing * j, side > 0 ? -r : -thickness + r};
        s.radius = r;
        s.normal = {0, 0, side};
        s.offset = side > 0 ? 0 : thickness;
        s.flat = edge ? 0 : 0.75 * spacing;
        s.area = spacing * spacing;
        set.spheres.push_back(s);
      }
  set.surfaceCount = set.spheres.size();
  return set;
}

/// Two plates that meet at a right angle along y: floor z = 0 (x > 0) and wall x = 0 (z > 0).
inline base::SphereSet corner(double halfWidth, double r, double spacing) {
  base::SphereSet set;
  set.name = "corner";
  set.radius = r, set.spacing = spacing;
  const int n = static_cast<int>(std::floor(2 * halfWidth / spacing)) + 1;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double along = spacing * i, y = -halfWidth + spacing * j;
        base::SetSphere s;
        s.centre = k == 0 ? base::Vec3d{along, y, -r} : base::Vec3d{-r, y, along};
        s.radius = r;
        s.normal = k == 0 ? base::Vec3d{0, 0, 1} : base::Vec3d{1, 0, 0};
        s.flat = 0.75 * spacing;
        s.area = spacing * spacing;
        set.spheres.push_back(s);
      }
  set.surfaceCount = set.spheres.size();
  return set;
}

inline PartMotion atRest(const base::Vec3d& origin, const base::Quat& orientation = {}) {
  return {origin, orientation.matrix(), origin, {}, {}};
}

} // namespace grouser::contact::testing

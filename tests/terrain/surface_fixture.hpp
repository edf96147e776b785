// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "tests/terrain/grain_fixture.hpp"

#include <functional>
#include <vector>

namespace grouser::terrain::testing {

using base::Vec3d;

/// Rotation by `angle` [rad] about `axis`.
inline base::Quat turn(const Vec3d& axis, double angle) {
  const Vec3d v = base::sin(0.5 * angle) * base::normalized(axis);
  return base::Quat{base::cos(0.5 * angle), v.x, v.y, v.z}.normalized();
}

/// A surface at `centre`, initially rotated by `stands` and since then by `turned`, with its velocities.
inline SurfacePose placed(const Vec3d& centre, const base::Quat& stands = {}, const base::Quat& turned = {},
                          const Vec3d& velocity = {}, const Vec3d& spin = {}) {
  return {{centre, (turned * stands).matrix(), centre, velocity, spin}, turned.matrix()};
}

inline SurfaceGeometry boxOf(const Vec3d& half) { return {SurfaceShape::box, half}; }
inline SurfaceGeometry tubeOf(double radius, double half) { return {SurfaceShape::tube, {radius, 0, half}}; }
inline SurfaceGeometry cylinderOf(double radius, double half) { return {SurfaceShape::cylinder, {radius, 0, half}}; }

/// Poses of the surfaces at step n.
using Motion = std::function<std::vector<SurfacePose>(std::int64_t step)>;

/// Steps from `first` to `last`, with the surfaces set before each.
inline void advanceWith(Grains& grains, const Motion& motion, std::int64_t first, std::int64_t last) {
  for (std::int64_t n = first; n < last; ++n) {
    grains.setSurfacePoses(motion(n));
    grains.refreshNeighbours();
    grains.step();
  }
}

/// A drum of radius 0.06 m rotating about y with a lifter inside, and a plate shaking in its lower half.
inline std::vector<RigidSurface> mill(const contact::ContactLaw& law) {
  const base::Quat aboutY = turn({1, 0, 0}, -base::kPi / 2); // z of the drum along y
  return {{tubeOf(0.06, 0.03), law, placed({}, aboutY)},
          {boxOf({0.004, 0.03, 0.01}), law, placed({0.05, 0, 0})},
          {boxOf({0.1, 0.1, 0.002}), law, placed({0, 0, -0.075})}};
}
inline Motion millMotion(double timeStep) {
  return [timeStep](std::int64_t n) {
    const double t = static_cast<double>(n) * timeStep, omega = 12, shake = 400;
    const base::Quat turned = turn({0, 1, 0}, omega * t), aboutY = turn({1, 0, 0}, -base::kPi / 2);
    const Vec3d spin{0, omega, 0}, arm = rotate(turned, {0.05, 0, 0});
    return std::vector<SurfacePose>{
        placed({}, aboutY, turned, {}, spin), placed(arm, {}, turned, cross(spin, arm), spin),
        placed({0, 0, -0.075 + 0.002 * base::sin(shake * t)}, {}, {}, {0, 0, 0.002 * shake * base::cos(shake * t)})};
  };
}

/// Grains that fill the lower half of the mill, and some around it.
inline std::vector<GrainSpec> millGrains() {
  std::vector<GrainSpec> start;
  for (int y = -2; y <= 2; ++y)
    for (int x = -3; x <= 3; ++x)
      for (int z = 0; z < 4; ++z) {
        const Vec3d p{0.0105 * x + 0.0003 * z, 0.0105 * y, -0.045 + 0.0105 * z};
        if (p.x * p.x + p.z * p.z < 0.054 * 0.054 && p.x < 0.038) start.push_back({p, {0.1, 0.05 * y, 0}, {3, 1, 2}});
      }
  for (int k = 0; k < 8; ++k) start.push_back({{0.09, -0.08 + 0.02 * k, -0.066}, {-0.3, 0, 0}, {}});
  return start;
}

inline GrainModel millModel(double skin = 0.3) {
  GrainModel m = ball(1e-5);
  m.gravity = {0, 0, -9.81};
  makeRough(m.law, 1500);
  m.skin = skin;
  return m;
}

} // namespace grouser::terrain::testing

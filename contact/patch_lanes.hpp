// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd.hpp"
#include "contact/patch_law.hpp"

/// Eight contact points in SIMD lanes, of one patch or of eight patches.
namespace grouser::contact {

inline constexpr int kPointLanes = 8;
using PointLanes = base::Simd<double, kPointLanes>;
using Vec3P = base::Vec3<PointLanes>;

GROUSER_SIMD PointLanes allLanes(double x) { return base::broadcast<PointLanes>(x); }
GROUSER_SIMD Vec3P allLanes(const base::Vec3d& v) { return base::broadcast<PointLanes>(v); }
GROUSER_SIMD PointLanes greater(const PointLanes& a, const PointLanes& b) { return a > b ? a : b; }
GROUSER_SIMD PointLanes lesser(const PointLanes& a, const PointLanes& b) { return a < b ? a : b; }

/// Contact pressure of one patch in one step, summed over its points. Positions and moments refer to one point of A.
template <class T> struct PressureOf {
  T area, weight;        ///< contact area [m2]; sum of normal force magnitudes [N]
  base::Vec3<T> place;   ///< sum of normal force magnitude x position [N m]
  base::Vec3<T> force;   ///< on A [N]
  base::Vec3<T> torque;  ///< on A, about the reference point [N m]
  T elastic, dissipated; ///< [J]

  PressureOf& operator+=(const PressureOf& o) {
    area += o.area, weight += o.weight, place += o.place, force += o.force, torque += o.torque;
    elastic += o.elastic, dissipated += o.dissipated;
    return *this;
  }
};
using PatchPressure = PressureOf<double>;

/// Motion of A relative to B: velocity of the reference point [m/s] and angular velocity [rad/s].
template <class T> struct RelativeMotion { base::Vec3<T> velocity, spin; };

GROUSER_SIMD RelativeMotion<PointLanes> allLanes(const RelativeMotion<double>& m) {
  return {allLanes(m.velocity), allLanes(m.spin)};
}

struct PressureLanes : PressureOf<PointLanes> {
  GROUSER_SIMD void clear() {
    const PointLanes none = allLanes(0);
    area = weight = elastic = dissipated = none;
    place = force = torque = {none, none, none};
  }

  /// Adds one point per lane. `x`: position from the reference point, halfway through the overlap [m]; `normal`:
  /// outward unit normal of B; `overlap` [m]; `share`: area that the point represents [m2].
  GROUSER_SIMD void add(const PatchLaw& law, double timeStep, const RelativeMotion<PointLanes>& motion, const Vec3P& x,
                        const Vec3P& normal, const PointLanes& overlap, const PointLanes& share) {
    const PointLanes opening = dot(motion.velocity + cross(motion.spin, x), normal);
    const Vec3P pressed = normal * addSize(law, timeStep, x, overlap, share, opening);
    force += pressed;
    torque += cross(x, pressed);
  }

  /// Adds to all sums except force and torque. Returns the magnitudes of the normal forces [N].
  GROUSER_SIMD PointLanes addSize(const PatchLaw& law, double timeStep, const Vec3P& x, const PointLanes& overlap,
                                  const PointLanes& share, const PointLanes& opening) {
    const PointLanes touching = overlap > allLanes(0) ? share : allLanes(0);
    const PointPressure<PointLanes> p = pressureAt(law, timeStep, touching, overlap, opening);
    area += touching;
    weight += p.size;
    place += x * p.size;
    elastic += p.elastic;
    dissipated += p.dissipated;
    return p.size;
  }

  /// Pressure of the patch in lane `l`.
  GROUSER_SIMD PatchPressure lane(int l) const {
    const auto at = [l](const Vec3P& v) { return base::Vec3d{v.x[l], v.y[l], v.z[l]}; };
    return {area[l], weight[l], at(place), at(force), at(torque), elastic[l], dissipated[l]};
  }
  /// Sum over all lanes, for a patch that occupies all of them.
  GROUSER_SIMD PatchPressure sum() const {
    const auto over = [](const PointLanes& v) {
      return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
    };
    const auto of = [&](const Vec3P& v) { return base::Vec3d{over(v.x), over(v.y), over(v.z)}; };
    return {over(area), over(weight), of(place), of(force), of(torque), over(elastic), over(dissipated)};
  }
};

} // namespace grouser::contact

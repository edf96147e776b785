// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/parts.hpp"
#include "assets/generator/solids.hpp"
#include "base/math.hpp"

#include <cmath>
#include <stdexcept>

namespace grouser::assets {
namespace {

/// A point of the gap profile in polar coordinates about the axle; the angle starts at the middle of the gap.
struct Polar {
  double angle, radius;
};

/// One period of the sprocket's outline, from the middle of a gap to the middle of the next.
std::vector<Polar> toothPeriod(const SprocketDims& d) {
  auto polar = [&](double x, double y) {
    const double radial = d.pinRadius + y;
    return Polar{base::atan2(x, radial), std::sqrt(x * x + radial * radial)};
  };
  // Half of a gap, from the bottom to the tip: the seat arc, then the flank arc.
  std::vector<Polar> half;
  const double seatEnd = d.seatHalfAngle * base::kPi / 180;
  const int seat = d.seatSegments / 2;
  for (int i = 0; i < seat; ++i) {
    const double a = seatEnd * i / seat;
    half.push_back(polar(d.seatRadius * base::sin(a), -d.seatRadius * base::cos(a)));
  }
  const double from =
      base::atan2(-d.seatRadius * base::cos(seatEnd) - d.flankY, d.seatRadius * base::sin(seatEnd) - d.flankX);
  const double to = base::atan2(d.tipY - d.flankY, d.tipX - d.flankX);
  for (int i = 0; i <= d.flankSegments; ++i) {
    const double a = from + (to - from) * i / d.flankSegments;
    half.push_back(polar(d.flankX + d.flankRadius * base::cos(a), d.flankY + d.flankRadius * base::sin(a)));
  }

  std::vector<Polar> period(half);
  const double pitchAngle = 2 * base::kPi / d.teeth, tip = half.back().angle;
  for (int i = 1; i < d.landSegments; ++i)
    period.push_back({tip + (pitchAngle - 2 * tip) * i / d.landSegments, d.landRadius});
  for (std::size_t i = half.size(); i-- > 1;) period.push_back({pitchAngle - half[i].angle, half[i].radius});
  return period;
}

} // namespace

TriangleMesh wheel(const WheelDims& wheel, const TrackDims& dims) {
  const double inner = dims.wheelGap / 2, outer = dims.plateOuter, r = wheel.radius, c = dims.chamfer;
  TriangleMesh mesh;
  lathe(mesh,
        {{-outer, r - c},
         {-outer + c, r},
         {-inner - c, r},
         {-inner, r - c},
         {-inner, wheel.hubRadius},
         {inner, wheel.hubRadius},
         {inner, r - c},
         {inner + c, r},
         {outer - c, r},
         {outer, r - c}},
        0, 0, wheel.facets);
  return mesh;
}

TriangleMesh sprocket(const SprocketDims& dims) {
  const std::vector<Polar> period = toothPeriod(dims);
  std::vector<double> angles, radii;
  for (int k = 0; k < dims.teeth; ++k)
    for (const Polar& p : period) {
      angles.push_back(p.angle + 2 * base::kPi * k / dims.teeth);
      radii.push_back(p.radius);
    }
  // Fixed radius, or 0 for the outline of the teeth.
  auto ring = [&](double y, double fixedRadius) {
    Ring points;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double r = fixedRadius > 0 ? fixedRadius : radii[i];
      points.push_back({r * base::cos(angles[i]), y, r * base::sin(angles[i])});
    }
    return points;
  };

  // One shell: the hub, which projects 2 mm from the rings, and the two rings.
  const double hub = dims.hubRadius, end = dims.ringOuter + 0.002;
  TriangleMesh mesh;
  loft(mesh,
       {ring(-end, hub), ring(-dims.ringOuter, hub), ring(-dims.ringOuter, 0), ring(-dims.ringInner, 0),
        ring(-dims.ringInner, hub), ring(dims.ringInner, hub), ring(dims.ringInner, 0), ring(dims.ringOuter, 0),
        ring(dims.ringOuter, hub), ring(end, hub)},
       {0, -end, 0}, {0, end, 0});
  return mesh;
}

TriangleMesh grouserWheel(const GrouserWheelDims& dims) {
  const double pitch = 2 * base::kPi / dims.grousers, half = 0.5 * dims.grouserThickness;
  const double tip = dims.radius + dims.grouserHeight;
  const double foot = base::atan2(half, dims.radius); // half angle of a blade at its foot
  if (dims.grousers < 3 || dims.facets < 1 || !(2 * foot < pitch))
    throw std::invalid_argument("grousers overlap at the drum; use fewer or thinner grousers");
  std::vector<Polar> outline;
  for (int k = 0; k < dims.grousers; ++k) {
    const double middle = pitch * k, end = base::atan2(half, tip);
    outline.push_back({middle - end, std::sqrt(tip * tip + half * half)});
    outline.push_back({middle + end, std::sqrt(tip * tip + half * half)});
    for (int i = 0; i <= dims.facets; ++i)
      outline.push_back({middle + foot + (pitch - 2 * foot) * i / dims.facets, dims.radius});
  }
  const auto ring = [&](double y) {
    Ring points;
    for (const Polar& p : outline) points.push_back({p.radius * base::cos(p.angle), y, p.radius * base::sin(p.angle)});
    return points;
  };
  TriangleMesh mesh;
  loft(mesh, {ring(-0.5 * dims.width), ring(0.5 * dims.width)}, {0, -0.5 * dims.width, 0}, {0, 0.5 * dims.width, 0});
  return mesh;
}

} // namespace grouser::assets

// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/shoe_points.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::vehicle {
namespace {

/// Collects surface points face by face.
class Faces {
public:
  /// `radius`: radius of the balls that are tangent to the faces from inside [m].
  Faces(double spacing, double radius) : spacing_(spacing), radius_(radius) {}

  /// Adds a trapezoid from the edge p +- a to the edge q +- b, facing `outward`.
  void add(const Vec3d& p, const Vec3d& a, const Vec3d& q, const Vec3d& b, const Vec3d& outward) {
    const Vec3d up = q - p;
    const double width = 2 * std::max(norm(a), norm(b)), height = norm(up);
    if (!(width > 0) || !(height > 0)) return;
    const int across = cells(width), along = cells(height);
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < across; ++j) {
        const double u = (i + 0.5) / along, v = 2 * (j + 0.5) / across - 1;
        const Vec3d half = a + (b - a) * u;
        put(p + up * u + half * v, 2 * norm(half) * height / (along * across), outward);
      }
  }

  /// Adds a rectangle about `middle` with the half edges a and b.
  void rectangle(const Vec3d& middle, const Vec3d& a, const Vec3d& b, const Vec3d& outward) {
    add(middle - b, a, middle + b, a, outward);
  }

  /// Adds a cylinder along y.
  void cylinder(double x, double z, double radius, double from, double to) {
    const int around = std::max(8, cells(2 * base::kPi * radius)), along = cells(to - from);
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * base::kPi * (k + 0.5) / around;
      const Vec3d out{base::cos(angle), 0, base::sin(angle)};
      for (int i = 0; i < along; ++i)
        put({x + radius * out.x, from + (to - from) * (i + 0.5) / along, z + radius * out.z},
            2 * base::kPi * radius * (to - from) / (around * along), out);
    }
  }

  /// Adds a disc normal to y.
  void disc(double x, double y, double z, double radius, const Vec3d& outward) {
    const int rings = cells(radius);
    for (int ring = 0; ring < rings; ++ring) {
      const double middle = radius * (ring + 0.5) / rings;
      const int around = std::max(4, cells(2 * base::kPi * middle));
      for (int k = 0; k < around; ++k) {
        const double angle = 2 * base::kPi * (k + 0.5) / around;
        put({x + middle * base::cos(angle), y, z + middle * base::sin(angle)},
            2 * base::kPi * middle * radius / (rings * around), outward);
      }
    }
  }

  std::vector<contact::SurfaceSample> take() { return std::move(points_); }

private:
  int cells(double length) const { return std::max(1, static_cast<int>(std::ceil(length / spacing_ - 1e-9))); }
  void put(const Vec3d& at, double area, const Vec3d& n) {
    points_.push_back({(at - n * radius_).as<float>(), static_cast<float>(radius_), static_cast<float>(area),
                       contact::mainDirection(n)});
  }

  double spacing_, radius_;
  std::vector<contact::SurfaceSample> points_;
};

} // namespace

std::vector<contact::SurfaceSample> shoePoints(const VehicleSpec& spec, double spacing) {
  const ShoeSpec& s = spec.shoe;
  const GearShapes& g = *spec.shapes;
  Faces faces(spacing, std::min(0.5 * spacing, 0.25 * std::min(g.grouserWidth, g.hornTipWidth)));
  const double length = s.halfLength, width = s.padHalfWidth, c = g.chamfer, bottom = s.padBottom, top = g.padTop;
  const Vec3d down{0, 0, -1}, ahead{1, 0, 0}, left{0, 1, 0}, up{0, 0, 1};

  // Lower face of the pad, between its chamfered ends and the feet of the grousers.
  std::vector<double> grousers;
  if (s.grouserHeight > 0) grousers = g.grouserX > 0 ? std::vector{-g.grouserX, g.grouserX} : std::vector{0.0};
  const double foot = 0.5 * g.grouserWidth, tip = bottom - s.grouserHeight;
  double from = -length + c;
  const auto pad = [&](double to) {
    if (to > from) faces.rectangle({0.5 * (from + to), 0, bottom}, left * width, ahead * (0.5 * (to - from)), down);
  };
  for (const double x : grousers) {
    pad(x - foot);
    from = x + foot;
    faces.rectangle({x, 0, tip}, left * width, ahead * (foot - c), down);
    for (const double side : {-1.0, 1.0}) {
      const Vec3d edge{x + side * (foot - c), 0, tip}, flank{x + side * foot, 0, tip + c};
      faces.add(edge, left * width, flank, left * width, down);
      faces.add(flank, left * width, {x + side * foot, 0, bottom}, left * width, ahead * side);
    }
  }
  pad(length - c);
  for (const double side : {-1.0, 1.0}) {
    const Vec3d edge{side * (length - c), 0, bottom}, end{side * length, 0, bottom + c};
    faces.add(edge, left * width, end, left * width, down);
    faces.add(end, left * width, {side * length, 0, top}, left * width, ahead * side);
    faces.rectangle({0, side * width, 0.5 * (bottom + top)}, ahead * length, up * (0.5 * (top - bottom)), left * side);
    const double middle = 0.5 * side * (g.plateInner + g.plateOuter), half = 0.5 * (g.plateOuter - g.plateInner);
    faces.rectangle({0, middle, s.plateTop}, left * half, ahead * length, up);
    for (const double sign : {-1.0, 1.0})
      faces.rectangle({sign * length, middle, 0.5 * (top + s.plateTop)}, left * half, up * (0.5 * (s.plateTop - top)),
                      ahead * sign);
    faces.rectangle({0, side * g.plateOuter, 0.5 * (top + s.plateTop)}, ahead * length, up * (0.5 * (s.plateTop - top)),
                    left * side);
    // Sides and ends of the horn.
    const double hornTop = s.plateTop + s.hornHeight;
    faces.add({0, 0.5 * side * g.hornWidth, s.plateTop}, ahead * (0.5 * g.hornLength),
              {0, 0.5 * side * g.hornTipWidth, hornTop}, ahead * (0.5 * g.hornTipLength), left * side);
    faces.add({0.5 * side * g.hornLength, 0, s.plateTop}, left * (0.5 * g.hornWidth),
              {0.5 * side * g.hornTipLength, 0, hornTop}, left * (0.5 * g.hornTipWidth), ahead * side);
    faces.cylinder(0.5 * s.pitch, 0, g.bossRadius, side < 0 ? -g.bossOuter : g.bossInner,
                   side < 0 ? -g.bossInner : g.bossOuter);
    faces.disc(0.5 * s.pitch, side * g.bossOuter, 0, g.bossRadius, left * side);
  }
  faces.rectangle({0, 0, s.plateTop + s.hornHeight}, left * (0.5 * g.hornTipWidth), ahead * (0.5 * g.hornTipLength),
                  up);
  return faces.take();
}

} // namespace grouser::vehicle

// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/shape_check.hpp"

#include "base/math.hpp"
#include "spheredecomp/mesh_query.hpp"
#include "vehicle/gap_profile.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::vehicle {
namespace {

/// Points that are on the surface of a part if the value of one key is right.
struct Claim {
  const char* key;
  std::vector<Vec3d> points;
};

/// Checks pairs of lengths: the first must be smaller.
std::optional<SpecFault> orderFault(const VehicleSpec& spec) {
  const GearShapes& g = *spec.shapes;
  struct Order {
    const char *key, *limit;
    double value, most;
  };
  const double half = spec.shoe.halfLength, pins = spec.sprocketPinRadius();
  double grouser = base::kInfinity;
  if (spec.shoe.grouserHeight > 0) grouser = spec.shoe.grouserHeight;
  for (const Order& o :
       {Order{"plate_inner", "plate_outer", g.plateInner, g.plateOuter},
        Order{"boss_inner", "boss_outer", g.bossInner, g.bossOuter},
        Order{"disc_inner", "disc_outer", g.discInner + 2 * g.discChamfer, g.discOuter},
        Order{"ring_inner", "ring_outer", g.ringInner, g.ringOuter},
        Order{"boss_radius", "seat_radius", g.bossRadius, g.seatRadius},
        Order{"horn_tip_length", "horn_length", g.hornTipLength, g.hornLength * (1 + 1e-12)},
        Order{"horn_tip_width", "horn_width", g.hornTipWidth, g.hornWidth * (1 + 1e-12)},
        Order{"chamfer", "half of grouser_width", g.chamfer, 0.5 * g.grouserWidth},
        Order{"grouser_x", "shoe.half_length minus half a grouser and a chamfer", g.grouserX,
              half - 0.5 * g.grouserWidth - g.chamfer + 1e-12},
        Order{"horn_width", "twice disc_inner", g.hornWidth, 2 * g.discInner},
        Order{"boss_inner", "ring_outer", g.bossInner, g.ringOuter},
        Order{"ring_inner", "boss_outer", g.ringInner, g.bossOuter},
        Order{"pad_top", "shoe.plate_top", g.padTop, spec.shoe.plateTop + 1e-12},
        Order{"chamfer", "pad_top minus shoe.pad_bottom", g.chamfer, g.padTop - spec.shoe.padBottom},
        Order{"chamfer", "shoe.grouser_height", g.chamfer, grouser},
        Order{"tip_radius", "the pin circle radius plus twice seat_radius", g.tipRadius, pins + 2 * g.seatRadius}})
    if (!(o.value < o.most))
      return SpecFault{"shapes", o.key, fmt::format("[m] must be below {:.6g}, {}", o.most, o.limit)};
  if (!(g.tipRadius > pins))
    return SpecFault{"shapes", "tip_radius", fmt::format("[m] must be above {:.6g}, the pin circle radius", pins)};
  if (spec.sprocket.teeth > contact::GapProfile::kMaxTeeth)
    return SpecFault{"sprocket", "teeth",
                     fmt::format("[-] must be at most {} if the file has [shapes]", contact::GapProfile::kMaxTeeth)};
  const contact::GapProfile gap = gapProfile(spec);
  const double middle = base::kPi / gap.teeth;
  const double x = g.tipRadius * base::sin(middle) - gap.flankX,
               y = g.tipRadius * base::cos(middle) - pins - gap.flankY;
  if (x * x + y * y > g.flankRadius * g.flankRadius)
    return SpecFault{
        "shapes", "flank_radius",
        "[m] is too small: the flank circle does not reach the middle of the tooth tip; remove the section "
        "[shapes], or set vehicle.gear_contact_model = \"samples\""};
  return {};
}

std::vector<Claim> discClaims(const GearShapes& g, double radius) {
  std::vector<Claim> claims{{"disc_inner", {}}, {"disc_outer", {}}};
  for (const double side : {-1.0, 1.0})
    for (int k = 0; k < 5; ++k) {
      const double a = 1.3 * k, c = base::cos(a), s = base::sin(a), flat = radius - g.discChamfer;
      const auto at = [&](double r, double y) { return Vec3d{r * c, side * y, r * s}; };
      claims[0].points.push_back(at(flat, g.discInner));
      claims[0].points.push_back(at(radius, g.discInner + g.discChamfer));
      claims[1].points.push_back(at(flat, g.discOuter));
      claims[1].points.push_back(at(radius, g.discOuter - g.discChamfer));
    }
  return claims;
}

std::vector<Claim> toothClaims(const VehicleSpec& spec) {
  const GearShapes& g = *spec.shapes;
  const contact::GapProfile gap = gapProfile(spec);
  const double pins = gap.pinRadius;
  std::vector<Claim> claims{
      {"seat_radius", {}}, {"flank_radius", {}}, {"tip_radius", {}}, {"ring_inner", {}}, {"ring_outer", {}}};
  const double middle = 0.5 * (g.ringInner + g.ringOuter);
  const auto at = [&](double x, double y, double across) { return Vec3d{pins + y, across, x}; };
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k <= 4; ++k) {
      const double a = 0.25 * k * g.seatHalfAngle;
      const double x = g.seatRadius * base::sin(a), y = -g.seatRadius * base::cos(a);
      for (const double ring : {-middle, middle}) claims[0].points.push_back(at(side * x, y, ring));
    }
    // Points up to a third of a radian along the flank from the seat, below the tip circle.
    for (int k = 1; k <= 5; ++k) {
      const double a = base::kPi / 2 + g.seatHalfAngle - 0.1 * k;
      const double x = gap.flankX + g.flankRadius * base::cos(a), y = gap.flankY + g.flankRadius * base::sin(a);
      if (std::sqrt(x * x + (pins + y) * (pins + y)) < g.tipRadius) claims[1].points.push_back(at(side * x, y, middle));
    }
    const double half = base::kPi / spec.sprocket.teeth, flat = 0.5 * (pins + g.tipRadius);
    claims[3].points.push_back({flat * base::cos(half), side * g.ringInner, flat * base::sin(half)});
    claims[4].points.push_back({flat * base::cos(half), side * g.ringOuter, flat * base::sin(half)});
    claims[2].points.push_back({g.tipRadius * base::cos(half), side * middle, side * g.tipRadius * base::sin(half)});
  }
  return claims;
}

std::vector<Claim> shoeClaims(const VehicleSpec& spec) {
  const ShoeSpec& s = spec.shoe;
  const GearShapes& g = *spec.shapes;
  std::vector<Claim> claims{{"plate_inner", {}},     {"plate_outer", {}},    {"horn_length", {}}, {"horn_width", {}},
                            {"horn_tip_length", {}}, {"horn_tip_width", {}}, {"boss_radius", {}}, {"boss_inner", {}},
                            {"boss_outer", {}},      {"grouser_x", {}},      {"pad_top", {}}};
  const double tip = s.padBottom - s.grouserHeight, foot = 0.5 * g.grouserWidth;
  for (const double side : {-1.0, 1.0}) {
    for (const double x : {-0.7, 0.0, 0.7}) {
      // Points on the sides of the plates, slightly below their faces.
      const double below = s.plateTop - 0.3 * (s.plateTop - g.padTop);
      claims[0].points.push_back({x * s.halfLength, side * g.plateInner, below});
      claims[1].points.push_back({x * s.halfLength, side * g.plateOuter, below});
      claims[10].points.push_back({x * s.halfLength, side * (s.padHalfWidth - g.chamfer), g.padTop});
    }
    // Points on the horn's ends and sides, near its foot and its tip.
    const auto between = [](double low, double high, double share) { return 0.5 * (low + share * (high - low)); };
    for (const std::size_t end : {std::size_t{0}, std::size_t{2}}) {
      const double share = end == 0 ? 0.1 : 0.9, z = s.plateTop + share * s.hornHeight;
      claims[2 + end].points.push_back({side * between(g.hornLength, g.hornTipLength, share), 0, z});
      claims[3 + end].points.push_back({0, side * between(g.hornWidth, g.hornTipWidth, share), z});
    }
    // The bosses are beside the pad, clear of other surfaces.
    for (int k = 0; k < 8; ++k) {
      const double a = 0.8 * k, x = 0.5 * s.pitch + g.bossRadius * base::cos(a), z = g.bossRadius * base::sin(a);
      claims[6].points.push_back({x, side * 0.5 * (g.bossInner + g.bossOuter), z});
      // Points on the ends of the bosses, beside the pins.
      const double inX = 0.5 * s.pitch + 0.8 * (x - 0.5 * s.pitch);
      claims[7].points.push_back({inX, side * g.bossInner, 0.8 * z});
      claims[8].points.push_back({inX, side * g.bossOuter, 0.8 * z});
    }
    if (s.grouserHeight > 0)
      for (const double edge : {g.grouserX - foot + g.chamfer, g.grouserX + foot - g.chamfer})
        claims[9].points.push_back({side * edge, 0.5 * side * s.padHalfWidth, tip});
  }
  return claims;
}

std::optional<SpecFault> claimFault(const std::vector<Claim>& claims, const base::TriangleMesh& mesh,
                                    const std::string& name, double tolerance) {
  if (mesh.vertices.empty()) return {};
  const spheredecomp::MeshQuery query(mesh);
  for (const Claim& claim : claims)
    for (const Vec3d& p : claim.points)
      if (const double off = query.closest(p).distance; off > tolerance)
        return SpecFault{
            "shapes", claim.key,
            fmt::format(
                "[m] does not match {4}: the point ({0:.4f}, {1:.4f}, {2:.4f}) m is {3:.1f} mm off the surface; "
                "use the dimension of the mesh, remove the section [shapes], or set "
                "vehicle.gear_contact_model = \"samples\"",
                p.x, p.y, p.z, 1e3 * off, name)};
  return {};
}

} // namespace

std::optional<SpecFault> shapeFault(const VehicleSpec& spec, const PartMeshes& meshes) {
  if (!spec.shapes) return {};
  if (auto fault = orderFault(spec)) return fault;
  const double tolerance = std::min(1e-3, 0.01 * spec.shoe.pitch);
  if (auto fault = claimFault(shoeClaims(spec), meshes.shoe, spec.shoe.mesh, tolerance)) return fault;
  if (auto fault = claimFault(toothClaims(spec), meshes.sprocket, spec.sprocket.mesh, tolerance)) return fault;
  const GearShapes& g = *spec.shapes;
  if (auto fault = claimFault(discClaims(g, spec.roadWheel.radius), meshes.roadWheel, spec.roadWheel.mesh, tolerance))
    return fault;
  if (auto fault = claimFault(discClaims(g, spec.roller.radius), meshes.roller, spec.roller.mesh, tolerance))
    return fault;
  return claimFault(discClaims(g, spec.idler.radius), meshes.idler, spec.idler.mesh, tolerance);
}

} // namespace grouser::vehicle

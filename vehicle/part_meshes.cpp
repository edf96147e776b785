// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/part_meshes.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace grouser::vehicle {
namespace {

using base::TriangleMesh;

constexpr double kFits = 1e-3; // [m] tolerated difference of mesh and spec

double radiusAt(const Vec3d& p) { return std::sqrt(p.x * p.x + p.z * p.z); }

/// Maximum of `measure` over the vertices accepted by `counts`; -infinity if there are none.
template <class Counts, class Measure> double most(const TriangleMesh& mesh, Counts counts, Measure measure) {
  double largest = -base::kInfinity;
  for (const Vec3d& v : mesh.vertices)
    if (counts(v)) largest = std::max(largest, measure(v));
  return largest;
}

bool all(const Vec3d&) { return true; }

SpecFault differs(const char* section, const char* key, const std::string& mesh, const char* what, double inMesh,
                  double value) {
  return {section, key,
          fmt::format("[m] does not fit the mesh {}, in which {} {:.1f} mm; set {}.{} = {:.6g}, or use a mesh of this "
                      "size",
                      mesh, what, 1e3 * inMesh, section, key, value)};
}

std::optional<SpecFault> rimFault(const char* section, double radius, const std::string& name,
                                  const TriangleMesh& mesh) {
  const double rim = most(mesh, all, radiusAt);
  if (std::fabs(rim - radius) <= kFits) return {};
  return differs(section, "radius", name, "the rim has a radius of", rim, std::floor(1e3 * rim + 0.5) / 1e3);
}

/// Pin bosses of a shoe's mesh, which are beside the pads. NaN if the mesh has no bosses.
struct Bosses {
  double x, radius; ///< x and radius of the bosses at the joint ahead [m]
};
Bosses bossesOf(const VehicleSpec& s, const TriangleMesh& shoe) {
  const auto beside = [&](const Vec3d& v) { return v.x > 0 && std::fabs(v.y) > s.shoe.padHalfWidth + kFits; };
  const double front = most(shoe, beside, [](const Vec3d& v) { return v.x; });
  const double rear = -most(shoe, beside, [](const Vec3d& v) { return -v.x; });
  return {0.5 * (front + rear), 0.5 * (front - rear)};
}

std::optional<SpecFault> shoeMeshFault(const VehicleSpec& s, const TriangleMesh& mesh) {
  const auto up = [](const Vec3d& v) { return v.z; };
  const auto down = [](const Vec3d& v) { return -v.z; };
  const auto middle = [&](const Vec3d& v) { return std::fabs(v.y) <= 0.5 * s.shoe.padHalfWidth; };
  const std::string& name = s.shoe.mesh;
  // Check the pads first: other lengths are measured beside or between the pads.
  const double pads = most(
      mesh, [&](const Vec3d& v) { return std::fabs(v.z - s.shoe.padBottom) <= kFits; },
      [](const Vec3d& v) { return std::fabs(v.y); });
  if (std::isfinite(pads) && std::fabs(pads - s.shoe.padHalfWidth) > kFits)
    return differs("shoe", "pad_half_width", name, "the pads reach to |y| =", pads, std::floor(1e3 * pads + 0.5) / 1e3);
  const double wide = most(mesh, all, [](const Vec3d& v) { return std::fabs(v.y); });
  if (wide < s.shoe.padHalfWidth - kFits)
    return differs("shoe", "pad_half_width", name, "all vertices lie within |y| =", wide,
                   std::floor(1e3 * wide + 0.5) / 1e3);
  if (const Bosses b = bossesOf(s, mesh); std::isfinite(b.x) && std::fabs(b.x - 0.5 * s.shoe.pitch) > kFits)
    return differs("shoe", "pitch", name, "the front pins are at x =", b.x, std::floor(2e3 * b.x + 0.5) / 1e3);
  const double half = most(mesh, middle, [](const Vec3d& v) { return std::fabs(v.x); });
  if (std::fabs(half - s.shoe.halfLength) > kFits)
    return differs("shoe", "half_length", name, "plate and pad reach to x =", half, std::floor(1e3 * half + 0.5) / 1e3);
  // Faces of plate and pad have vertices at their height.
  const auto hasFaceAt = [&](double z) {
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [&](const Vec3d& v) { return std::fabs(v.z - z) <= kFits; });
  };
  const double top = most(mesh, all, up), bottom = -most(mesh, all, down);
  if (!hasFaceAt(s.shoe.plateTop)) {
    const double plate = most(
        mesh, [&](const Vec3d& v) { return std::fabs(v.x) > 0.95 * half; }, up);
    return differs("shoe", "plate_top", name, "the plates end at z =", plate, plate);
  }
  if (!hasFaceAt(s.shoe.padBottom))
    return differs("shoe", "pad_bottom", name, "the grousers reach to z =", bottom, bottom + s.shoe.grouserHeight);
  if (std::fabs(top - s.shoe.plateTop - s.shoe.hornHeight) > kFits)
    return differs("shoe", "horn_height", name, "the horn reaches above the plate by", top - s.shoe.plateTop,
                   std::floor(1e3 * (top - s.shoe.plateTop) + 0.5) / 1e3);
  if (std::fabs(s.shoe.padBottom - s.shoe.grouserHeight - bottom) > kFits)
    return differs("shoe", "grouser_height", name, "the grousers reach below the pad by", s.shoe.padBottom - bottom,
                   std::floor(1e3 * (s.shoe.padBottom - bottom) + 0.5) / 1e3);
  return {};
}

/// Checks that the teeth are between the pins, and the pins in the gaps.
std::optional<SpecFault> teethFault(const VehicleSpec& s, const PartMeshes& meshes) {
  const double pins = s.sprocketPinRadius(), tip = most(meshes.sprocket, all, radiusAt);
  const auto tooth = [&](const Vec3d& v) { return base::cos(s.sprocket.teeth * base::atan2(v.z, v.x)); };
  double phase = 0;
  int beyond = 0;
  for (const Vec3d& v : meshes.sprocket.vertices)
    if (radiusAt(v) > pins + 0.8 * (tip - pins)) phase += tooth(v), ++beyond;
  if (tip < pins + kFits || tip > pins + s.shoe.pitch)
    return SpecFault{
        "sprocket", "teeth",
        fmt::format("[-] and shoe.pitch = {:g} m put the pins {:.1f} mm from the axle, but the teeth of {} "
                    "end at {:.1f} mm; choose teeth and pitch that fit the mesh, or use a matching mesh",
                    s.shoe.pitch, 1e3 * pins, s.sprocket.mesh, 1e3 * tip)};
  if (phase > -0.25 * beyond) // the tips are midway between two gaps
    return SpecFault{
        "sprocket", "teeth",
        fmt::format("[-]: the teeth of {} do not match this number of pins; set the number of teeth of the mesh, which "
                    "must have a gap on its x axis",
                    s.sprocket.mesh)};
  const Bosses boss = bossesOf(s, meshes.shoe);
  const double seat = most(
      meshes.sprocket, [&](const Vec3d& v) { return radiusAt(v) > 0.8 * pins && tooth(v) > 0.9999; }, radiusAt);
  if (!std::isfinite(boss.radius) || !std::isfinite(seat)) return {};
  const double slack = pins - boss.radius - seat;
  if (slack >= -0.5 * kFits && slack <= 3 * kFits) return {};
  return SpecFault{
      "shoe", "pitch",
      fmt::format("[m] and sprocket.teeth = {} put the pins {:.1f} mm from the axle, where their bosses {} "
                  "the gaps of {} by {:.1f} mm; choose a pitch of {:.4f} m or a mesh that fits",
                  s.sprocket.teeth, 1e3 * pins, slack < 0 ? "overlap" : "miss", s.sprocket.mesh, 1e3 * std::fabs(slack),
                  2 * (seat + boss.radius) * base::sin(base::kPi / s.sprocket.teeth))};
}

/// Radius of the hub between a wheel's discs [m]: maximum radius of the mesh within |y| <= half.
double hubRadius(const TriangleMesh& mesh, double half) {
  double largest = 0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d a = mesh.vertices[mesh.indices[t + k]], b = mesh.vertices[mesh.indices[t + (k + 1) % 3]];
      // Clip the edge to the band; the radius has its maximum at one end of the clipped edge.
      double from = 0, to = 1;
      for (const double side : {-1.0, 1.0}) {
        const double da = half - side * a.y, db = half - side * b.y; // inside if >= 0
        if (da < 0 && db < 0) from = 1, to = 0;
        if (da < 0 && db >= 0) from = std::max(from, da / (da - db));
        if (da >= 0 && db < 0) to = std::min(to, da / (da - db));
      }
      if (from > to) continue;
      for (const double at : {from, to}) largest = std::max(largest, radiusAt(a + (b - a) * at));
    }
  return largest;
}

std::optional<SpecFault> hornFault(const VehicleSpec& s, const PartMeshes& meshes) {
  const double tip = s.shoe.plateTop + s.shoe.hornHeight;
  const double half = most(
      meshes.shoe, [&](const Vec3d& v) { return v.z > tip - kFits; }, [](const Vec3d& v) { return std::fabs(v.y); });
  struct Rim {
    const char* name;
    double radius;
    const TriangleMesh& mesh;
  };
  for (const Rim& r : {Rim{"road wheels", s.roadWheel.radius, meshes.roadWheel},
                       Rim{"rollers", s.roller.radius, meshes.roller}, Rim{"idler", s.idler.radius, meshes.idler}}) {
    if (r.mesh.vertices.empty()) continue; // a vehicle without rollers
    if (const double overlap = hubRadius(r.mesh, half) - (r.radius - s.shoe.hornHeight); overlap > 0)
      return SpecFault{"shoe", "horn_height",
                       fmt::format("[m] makes the horns overlap the hub of the {} by {:.1f} mm; set shoe.horn_height "
                                   "to at most {:.4f} with a mesh of that height",
                                   r.name, 1e3 * overlap, s.shoe.hornHeight - overlap)};
  }
  return {};
}

/// A length of a part in its mesh, and the key of the spec that it should about agree with.
struct PartLength {
  double inMesh, inSpec; ///< [m]
  const char *what, *key;
};
PartLength lengthOf(const std::string& section, const VehicleSpec& s, const TriangleMesh& mesh) {
  const auto along = [](const Vec3d& v) { return std::fabs(v.x); };
  if (section == "chassis") return {most(mesh, all, along), std::fabs(s.idler.x), "length", "idler.x"};
  if (section == "shoe") return {most(mesh, all, along), 0.5 * s.shoe.pitch, "half length", "half of shoe.pitch"};
  const double radius = most(mesh, all, radiusAt);
  if (section == "sprocket") return {radius, s.sprocketPinRadius(), "radius", "the pin radius"};
  if (section == "roller") return {radius, s.roller.radius, "radius", "roller.radius"};
  if (section == "idler") return {radius, s.idler.radius, "radius", "idler.radius"};
  return {radius, s.roadWheel.radius, "radius", "road_wheel.radius"};
}

} // namespace

std::optional<SpecFault> unitFault(const std::string& section, const VehicleSpec& spec, const TriangleMesh& mesh) {
  struct Unit {
    const char* name;
    double metre; ///< length of a unit [m]
    double agree; ///< largest ratio of the lengths in mesh and spec after conversion
  };
  constexpr Unit kUnits[] = {
      {"feet", 0.3048, 1.3}, {"inches", 0.0254, 1.4}, {"centimetres", 0.01, 1.6}, {"millimetres", 0.001, 3}};
  constexpr double kRim = 1.05; // rims agree with their radius in the spec
  const bool isRim = section == "roller" || section == "idler" || section == "road_wheel";
  const PartLength length = lengthOf(section, spec, mesh);
  if (section == "chassis" && length.inMesh < 20 * length.inSpec) return {}; // a hull may be longer than its tracks
  for (const Unit& unit : kUnits) {
    const double ratio = length.inMesh * unit.metre / length.inSpec,
                 agree = isRim ? std::min(kRim, unit.agree) : unit.agree;
    if (ratio > agree || ratio < 1 / agree) continue;
    return SpecFault{section, "mesh",
                     fmt::format("has a {} of {:.4g} m, {:.4g} times {} = {:.4g} m, so its vertices are in {}; convert "
                                 "all meshes to metres (scale by {:g})",
                                 length.what, length.inMesh, length.inMesh / length.inSpec, length.key, length.inSpec,
                                 unit.name, unit.metre)};
  }
  return {};
}

std::optional<SpecFault> meshFault(const VehicleSpec& spec, const PartMeshes& meshes) {
  if (auto fault = rimFault("road_wheel", spec.roadWheel.radius, spec.roadWheel.mesh, meshes.roadWheel)) return fault;
  if (!spec.roller.x.empty())
    if (auto fault = rimFault("roller", spec.roller.radius, spec.roller.mesh, meshes.roller)) return fault;
  if (auto fault = rimFault("idler", spec.idler.radius, spec.idler.mesh, meshes.idler)) return fault;
  if (auto fault = shoeMeshFault(spec, meshes.shoe)) return fault;
  if (auto fault = teethFault(spec, meshes)) return fault;
  if (auto fault = hornFault(spec, meshes)) return fault;
  const double lowest = -most(meshes.chassis, all, [](const Vec3d& v) { return -v.z; });
  if (const double below = spec.groundHeight() - lowest; below > 0)
    return SpecFault{
        "road_wheel", "z",
        fmt::format("[m] leaves the hull's mesh {} {:.1f} mm below the lowest shoes; lower the road wheels, "
                    "or use another hull mesh",
                    spec.chassis.mesh, 1e3 * below)};
  return {};
}

} // namespace grouser::vehicle

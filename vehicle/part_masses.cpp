// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/part_masses.hpp"

#include "base/rounded.hpp"
#include "spheredecomp/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

namespace grouser::vehicle {
namespace {

using base::roundedDown;
using base::roundedUp;

/// Range of plausible densities, from air (a hull is mostly empty) to the heaviest metals [kg/m3].
constexpr double kMinDensity = 1, kMaxDensity = 25e3;
/// Range of radius of gyration / extent from the centre of mass [-]: below 1 for a solid, but meshes may be simplified.
constexpr double kMinGyration = 0.01, kMaxGyration = 2;

std::optional<SpecFault> densityFault(const char* section, double mass, const std::string& mesh, double volume) {
  const double density = mass / volume;
  if (density >= kMinDensity && density <= kMaxDensity) return {};
  return SpecFault{section, "mass",
                   fmt::format("[kg] in the {:.3g} m3 of {} implies a density of {:.3g} kg/m3, {}; choose a mass in "
                               "[{}, {}] kg, or correct the size of the mesh (in metres)",
                               volume, mesh, density,
                               density < kMinDensity ? "lighter than air" : "heavier than any metal",
                               roundedUp(kMinDensity * volume, 3), roundedDown(kMaxDensity * volume, 3))};
}

/// `reach`: extent of the part from its centre of mass [m].
std::optional<SpecFault> inertiaFault(const char* section, const char* key, double mass, const Vec3d& inertia,
                                      double reach, const char* what) {
  const double largest = std::max({inertia.x, inertia.y, inertia.z}), gyration = std::sqrt(largest / mass);
  if (gyration >= kMinGyration * reach && gyration <= kMaxGyration * reach) return {};
  return SpecFault{
      section, key,
      fmt::format("[kg m2] implies, for {:g} kg, a radius of gyration of {:.3g} m, but {} extends {:.3g} m from its "
                  "centre of mass; the largest moment must be in [{}, {}]",
                  mass, gyration, what, reach, roundedUp(kMinGyration * kMinGyration * reach * reach * mass, 3),
                  roundedDown(kMaxGyration * kMaxGyration * reach * reach * mass, 3))};
}

std::optional<SpecFault> surfaceFault(const char* section, const SurfaceSpec& part, const base::TriangleMesh& mesh,
                                      const Vec3d& centre = {}) {
  if (auto fault = densityFault(section, part.mass, part.mesh, spheredecomp::signedVolume(mesh))) return fault;
  double reach = 0;
  for (const Vec3d& v : mesh.vertices) reach = std::max(reach, norm(v - centre));
  return inertiaFault(section, "inertia", part.mass, part.inertia, reach, part.mesh.c_str());
}

/// Checks that the hull's centre of mass is outside its mesh by at most the size of the mesh.
std::optional<SpecFault> centreFault(const VehicleSpec& s, const base::TriangleMesh& mesh) {
  const auto [low, high] = spheredecomp::bounds(mesh);
  const Vec3d& centre = s.chassis.centre;
  const char *const axes[] = {"x", "y", "z"}, *const sizes[] = {"long", "wide", "high"};
  for (int a = 0; a < 3; ++a) {
    const double at = centre[a], size = high[a] - low[a], from = low[a] - size, to = high[a] + size;
    if (at >= from && at <= to) continue;
    const bool beyond = at > to;
    return SpecFault{"chassis", "centre",
                     fmt::format("[m] is {:.0f} mm {} the hull {}, further than the hull is {}; {} must be in [{:.3g}, "
                                 "{:.3g}]",
                                 1e3 * (beyond ? at - high[a] : low[a] - at), beyond ? "beyond" : "before",
                                 s.chassis.mesh, sizes[a], axes[a], from, to)};
  }
  return {};
}

} // namespace

std::optional<SpecFault> massFault(const VehicleSpec& s, const PartMeshes& meshes) {
  if (auto fault = centreFault(s, meshes.chassis)) return fault;
  if (auto fault = surfaceFault("chassis", s.chassis, meshes.chassis, s.chassis.centre)) return fault;
  if (auto fault = surfaceFault("shoe", s.shoe, meshes.shoe)) return fault;
  if (auto fault = surfaceFault("sprocket", s.sprocket, meshes.sprocket)) return fault;
  if (auto fault = surfaceFault("road_wheel", s.roadWheel, meshes.roadWheel)) return fault;
  if (!s.roller.x.empty())
    if (auto fault = surfaceFault("roller", s.roller, meshes.roller)) return fault;
  if (auto fault = surfaceFault("idler", s.idler, meshes.idler)) return fault;
  if (auto fault = inertiaFault("arm", "inertia", s.arm.mass, s.arm.inertia, s.arm.length, "the arm")) return fault;
  return inertiaFault("idler", "carrier_inertia", s.idler.carrierMass, s.idler.carrierInertia, s.idler.radius,
                      "the idler on it");
}

} // namespace grouser::vehicle

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/placement.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "runs/scene/scene.hpp"
#include "spheredecomp/decompose.hpp"
#include "spheredecomp/mesh.hpp"
#include "vehicle/assembly.hpp"
#include "vehicle/hull_clearance.hpp"
#include "vehicle/part_masses.hpp"
#include "vehicle/part_meshes.hpp"
#include "vehicle/shape_check.hpp"
#include "vehicle/spec_file.hpp"
#include "vehicle/wrap.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <vector>

namespace grouser::setup {

namespace {

constexpr double kBorder = 0.02; // [m] margin of the default position

/// Extent of the vehicle about its origin at a heading [m].
terrain::Rectangle footprint(const vehicle::VehicleSpec& spec, double heading) {
  const vehicle::Wrap wrap = vehicle::wrapTrack(spec);
  // In any orientation, a shoe extends at most half a pitch plus its grousers beyond its middle.
  const double reach = 0.5 * spec.shoe.pitch + spec.shoe.grouserHeight - spec.shoe.padBottom;
  double rear = 1e300, front = -1e300;
  for (int i = 0; i < spec.shoe.count; ++i) {
    rear = std::min(rear, wrap.shoeCentre(i).x - reach);
    front = std::max(front, wrap.shoeCentre(i).x + reach);
  }
  const double half = spec.trackOffset + std::max(spec.shoe.padHalfWidth, 0.175), c = base::cos(heading),
               s = base::sin(heading);
  terrain::Rectangle r{1e300, -1e300, 1e300, -1e300};
  for (const double x : {rear, front})
    for (const double y : {-half, half}) {
      r.xMin = std::min(r.xMin, c * x - s * y), r.xMax = std::max(r.xMax, c * x - s * y);
      r.yMin = std::min(r.yMin, s * x + c * y), r.yMax = std::max(r.yMax, s * x + c * y);
    }
  return r;
}

/// Coordinate of the origin along one axis: rear at the border, facing inwards, along the heading; otherwise centred.
double along(double direction, double low, double high, double areaLow, double areaHigh) {
  if (direction > 0.5) return areaLow - low + kBorder;
  if (direction < -0.5) return areaHigh - high - kBorder;
  return 0.5 * (areaLow + areaHigh) - 0.5 * (low + high);
}

} // namespace

std::optional<terrain::Rectangle> terrainArea(const scene::Scene& scene) {
  if (!scene.terrain) return {};
  const auto& size = scene.terrain->size;
  return terrain::Rectangle{0, size[0], -0.5 * size[1], 0.5 * size[1]};
}

vehicle::VehicleSpec vehicleSpec(const scene::Scene& scene) {
  vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  if (scene.vehicle->tracks == scene::Tracks::single) spec.trackOffset = 0;
  return spec;
}

coupling::Placement placeVehicle(const scene::Scene& scene, const vehicle::VehicleSpec& spec) {
  const double heading = scene.vehicle->heading * base::kPi / 180;
  const std::optional<terrain::Rectangle> area = terrainArea(scene);
  if (!area) {
    const auto place = scene.vehicle->position.value_or(std::array<double, 2>{0, 0});
    return {place[0], place[1], heading};
  }
  const terrain::Rectangle f = footprint(spec, heading);
  coupling::Placement p{along(base::cos(heading), f.xMin, f.xMax, area->xMin, area->xMax),
                        along(base::sin(heading), f.yMin, f.yMax, area->yMin, area->yMax), heading};
  if (scene.vehicle->position) p.x = (*scene.vehicle->position)[0], p.y = (*scene.vehicle->position)[1];
  if (p.x + f.xMin < area->xMin || p.x + f.xMax > area->xMax || p.y + f.yMin < area->yMin || p.y + f.yMax > area->yMax)
    scene.fail(
        "vehicle", "position",
        fmt::format("[m] places the vehicle at ({:.3f}, {:.3f}) m with vehicle.heading = {:g} [deg], where it covers "
                    "[{:.2f}, {:.2f}] x [{:.2f}, {:.2f}] m, beyond the terrain [{:.2f}, {:.2f}] x [{:.2f}, {:.2f}] m; "
                    "move it, or enlarge terrain.size (the vehicle requires {:.2f} x {:.2f} m)",
                    p.x, p.y, scene.vehicle->heading, p.x + f.xMin, p.x + f.xMax, p.y + f.yMin, p.y + f.yMax,
                    area->xMin, area->xMax, area->yMin, area->yMax, f.width(), f.length()));
  return p;
}

void checkSections(const scene::Scene& scene, const vehicle::VehicleSpec& spec) {
  if (scene.driver.drive == vehicle::SprocketDrive::engine && !spec.engine)
    scene.fail("driver", "drive",
               "requires a section [engine] in the vehicle file (see grouser fields --vehicle); add it, or set "
               "\"speed\" or \"torque\"");
  if (scene.vehicle->gearContactModel == vehicle::GearContactModel::shapes && !spec.shapes)
    scene.fail(
        "vehicle", "gear_contact_model",
        "requires a section [shapes] in the vehicle file (see grouser fields --vehicle); add it, or set \"samples\"");
}

void checkParts(const scene::Scene& scene) {
  if (scene.vehicle->chassis != scene::ChassisMount::fixed && scene.terrain && norm(scene.run.gravity) > 0 &&
      !(scene.run.gravity.z < 0))
    scene.fail("run", "gravity",
               fmt::format("[m/s2] must point down for a vehicle with chassis = \"{}\", whose weight presses the "
                           "tracks onto the ground; set z below 0, or vehicle.chassis = \"fixed\"",
                           base::wordOf(scene.vehicle->chassis)));
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  checkSections(scene, spec);
  const double radius = scene.vehicle->sphereRadius.value_or(0); // an automatic radius fits each part
  const auto read = [&](const char* section, const std::string& name) {
    base::TriangleMesh mesh;
    try {
      mesh = spheredecomp::importMesh((std::filesystem::path(spec.meshFolder) / name).string());
    } catch (const base::InputError& error) {
      vehicle::refuseMesh(scene.vehicle->source(), section, error.what());
    }
    if (const auto fault = vehicle::unitFault(section, spec, mesh)) vehicle::refuse(scene.vehicle->source(), *fault);
    return mesh;
  };
  vehicle::PartMeshes meshes;
  meshes.chassis = read("chassis", spec.chassis.mesh);
  struct Named {
    const char* section;
    const std::string& name;
    base::TriangleMesh& mesh;
  };
  for (const auto& [section, name, mesh] :
       {Named{"shoe", spec.shoe.mesh, meshes.shoe}, Named{"sprocket", spec.sprocket.mesh, meshes.sprocket},
        Named{"road_wheel", spec.roadWheel.mesh, meshes.roadWheel}, Named{"roller", spec.roller.mesh, meshes.roller},
        Named{"idler", spec.idler.mesh, meshes.idler}}) {
    if (&mesh == &meshes.roller && spec.roller.x.empty()) continue;
    mesh = read(section, name);
    if (radius == 0) continue;
    const auto [low, high] = spheredecomp::bounds(mesh);
    const double longest = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (radius > 0.5 * longest)
      scene.fail("vehicle", "sphere_radius",
                 fmt::format("[m] is above {} m, half of the longest side of {}; lower it",
                             base::roundedDown(0.5 * longest, 4), name));
    if (const double points = spheredecomp::latticePoints(mesh, radius); !(points <= spheredecomp::kMaxLatticePoints))
      scene.fail("vehicle", "sphere_radius",
                 fmt::format("[m] for {} requires {:.2g} lattice points, more than {:.0e}; raise it", name, points,
                             spheredecomp::kMaxLatticePoints));
  }
  if (const std::optional<double> coarse = scene.vehicle->hullSphereRadius) {
    const auto [low, high] = spheredecomp::bounds(meshes.chassis);
    const double longest = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (*coarse > 0.5 * longest)
      scene.fail("vehicle", "hull_sphere_radius",
                 fmt::format("[m] is above {} m, half of the longest side of {}; lower it",
                             base::roundedDown(0.5 * longest, 4), spec.chassis.mesh));
    if (const double points = spheredecomp::latticePoints(meshes.chassis, *coarse);
        !(points <= spheredecomp::kMaxLatticePoints))
      scene.fail("vehicle", "hull_sphere_radius",
                 fmt::format("[m] for {} requires {:.2g} lattice points, more than {:.0e}; raise it", spec.chassis.mesh,
                             points, spheredecomp::kMaxLatticePoints));
  }
  for (const auto& faultOf : {vehicle::meshFault, vehicle::massFault, vehicle::hullFault})
    if (const std::optional<vehicle::SpecFault> fault = faultOf(spec, meshes))
      vehicle::refuse(scene.vehicle->source(), *fault);
  if (scene.vehicle->gearContactModel != vehicle::GearContactModel::samples)
    if (const std::optional<vehicle::SpecFault> fault = vehicle::shapeFault(spec, meshes))
      vehicle::refuse(scene.vehicle->source(), *fault);
}

} // namespace grouser::setup

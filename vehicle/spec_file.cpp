// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/spec_file.hpp"

#include "base/error.hpp"
#include "base/table.hpp"
#include "vehicle/running_gear.hpp"
#include "vehicle/spec_tables.hpp"

#include <filesystem>
#include <optional>

namespace grouser::vehicle {

namespace {

/// Rules between keys, which no single range can state.
void checkTogether(const base::Section& root, const VehicleSpec& spec) {
  if (spec.roller.x.size() != spec.roller.z.size())
    root.section("roller").fail("z", "must have as many values as roller.x, one a roller");
  const auto principal = [&root](const std::string& section, const std::string& key, const Vec3d& i) {
    if (i.x > i.y + i.z || i.y > i.z + i.x || i.z > i.x + i.y)
      root.section(section).fail(key, "belongs to no solid body: no principal moment exceeds the sum of the other two");
  };
  principal("chassis", "inertia", spec.chassis.inertia);
  principal("shoe", "inertia", spec.shoe.inertia);
  principal("sprocket", "inertia", spec.sprocket.inertia);
  principal("road_wheel", "inertia", spec.roadWheel.inertia);
  principal("arm", "inertia", spec.arm.inertia);
  principal("roller", "inertia", spec.roller.inertia);
  principal("idler", "inertia", spec.idler.inertia);
  principal("idler", "carrier_inertia", spec.idler.carrierInertia);
}

} // namespace

VehicleSpec readVehicleSpec(const std::string& path) {
  const base::Document document = base::Document::load(path);
  const base::Section root = document.root();
  root.allowOnly(
      {"version", "vehicle", "chassis", "shoe", "sprocket", "road_wheel", "arm", "roller", "idler", "contact"});
  VehicleSpec spec = root.section("vehicle").read(vehicleTable());
  spec.chassis = root.section("chassis").read(chassisTable());
  spec.shoe = root.section("shoe").read(shoeTable());
  spec.sprocket = root.section("sprocket").read(sprocketTable());
  spec.roadWheel = root.section("road_wheel").read(roadWheelTable());
  spec.arm = root.section("arm").read(armTable());
  spec.roller = root.section("roller").read(rollerTable());
  spec.idler = root.section("idler").read(idlerTable());
  spec.contact = root.section("contact").read(contactTable());
  checkTogether(root, spec);
  if (const std::optional<SpecFault> fault = runningGearFault(spec))
    root.section(fault->section).fail(fault->key, fault->message);
  // The mesh folder is named from the spec file's own place.
  spec.meshFolder = (std::filesystem::path(path).parent_path() / spec.meshFolder).lexically_normal().string();
  return spec;
}

void refuse(const std::string& path, const SpecFault& fault) {
  const base::Document document = base::Document::load(path);
  document.root().section(fault.section).fail(fault.key, fault.message);
}

void refuseMesh(const std::string& path, const std::string& section, const std::string& why) {
  refuse(path, {section, "mesh", "in vehicle.mesh_folder is no mesh for it: " + why});
}

std::string specFieldHelp() {
  std::string text = R"(## Keys of a vehicle file

The file that `vehicle.spec` of a scene names. It begins with `version = 1`; all sections and keys are required. SI
units, angles in radians. Axes: x forward, y left, z up; origin: the middle of the sprockets' axle line. The two tracks
are alike. Inertia is about a part's centre of mass, along the axes of its frame.

A mesh is closed, its triangles face outward, its vertices are in metres in the frame of its part:

- chassis: the vehicle's frame, origin in the middle of the sprockets' axle line;
- shoe: origin in the middle between its two pin axes, x along the track, forward on the ground run, z towards the
  inside of the loop: its pins lie at x = +- pitch / 2, z = 0;
- sprocket, road wheel, roller, idler: origin on the axle, y along it; gap k of the sprocket at the angle
  2 pi k / teeth from +x towards +z, so deep that pins seat at the radius pitch / (2 sin(pi / teeth)).
)";
  const std::string tables[] = {
      base::describe(vehicleTable()),  base::describe(chassisTable()),   base::describe(shoeTable()),
      base::describe(sprocketTable()), base::describe(roadWheelTable()), base::describe(armTable()),
      base::describe(rollerTable()),   base::describe(idlerTable()),     base::describe(contactTable())};
  for (const std::string& table : tables) text.append("\n").append(table);
  return text;
}

} // namespace grouser::vehicle

// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/spec_file.hpp"

#include "base/nearest_key.hpp"

#include "base/error.hpp"
#include "base/name_fault.hpp"
#include "base/table.hpp"
#include "vehicle/running_gear.hpp"
#include "vehicle/spec_tables.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <optional>

namespace grouser::vehicle {

namespace {

void checkEngine(const base::Section& section, const EngineSpec& engine) {
  if (engine.speed.empty()) section.fail("speed", "[rad/s] is empty; set at least one point of the torque curve");
  if (engine.torque.size() != engine.speed.size())
    section.fail("torque", fmt::format("[N m] and speed differ in length; set one torque for each of the {} speeds",
                                       engine.speed.size()));
  for (std::size_t i = 1; i < engine.speed.size(); ++i)
    if (!(engine.speed[i] > engine.speed[i - 1]))
      section.fail("speed", fmt::format("[rad/s] does not increase at entry {}; sort it", i));
  if (*std::max_element(engine.torque.begin(), engine.torque.end()) <= 0)
    section.fail("torque", "[N m] is 0 at all speeds; set a torque > 0");
}

/// Checks conditions that involve several keys.
void checkTogether(const base::Section& root, const VehicleSpec& spec) {
  if (const std::string fault = base::textFault(spec.name, base::kLongestName); !fault.empty())
    root.section("vehicle").fail("name", fault);
  if (spec.arm.suspension == Suspension::sprung)
    for (const char* key : {"stiffness", "damping", "preload"})
      if (!root.section("arm").has(key))
        root.section("arm").fail(key, "is required for sprung arms; set it, or set suspension = \"rigid\"");
  if (spec.roller.x.size() != spec.roller.z.size())
    root.section("roller").fail("z", "must have as many values as roller.x, one per roller");
  const auto principal = [&root](const std::string& section, const std::string& key, const Vec3d& i) {
    if (i.x > i.y + i.z || i.y > i.z + i.x || i.z > i.x + i.y)
      root.section(section).fail(key, "is not physical: no principal moment may exceed the sum of the other two");
  };
  if (spec.engine) checkEngine(root.section("engine"), *spec.engine);
  principal("chassis", "inertia", spec.chassis.inertia);
  principal("shoe", "inertia", spec.shoe.inertia);
  principal("sprocket", "inertia", spec.sprocket.inertia);
  principal("road_wheel", "inertia", spec.roadWheel.inertia);
  principal("arm", "inertia", spec.arm.inertia);
  if (root.has("roller")) principal("roller", "inertia", spec.roller.inertia);
  principal("idler", "inertia", spec.idler.inertia);
  principal("idler", "carrier_inertia", spec.idler.carrierInertia);
}

/// Reads the file and applies the changed keys. Messages name the location in the file and of the change.
base::Document documentOf(const SpecSource& source) {
  base::Document document = base::Document::load(source.file);
  for (const SpecKey& k : source.changed) {
    base::Node value = k.value;
    value.origin = fmt::format("{}, overriding {}", k.value.origin, source.file);
    document.put(k.section, k.key, value);
  }
  return document;
}

/// Reads all sections.
VehicleSpec readSections(const base::Section& root) {
  root.allowOnly({"version", "vehicle", "chassis", "shoe", "sprocket", "road_wheel", "arm", "roller", "idler",
                  "contact", "engine", "shapes"});
  VehicleSpec spec = root.section("vehicle").read(vehicleTable());
  spec.chassis = root.section("chassis").read(chassisTable());
  spec.shoe = root.section("shoe").read(shoeTable());
  spec.sprocket = root.section("sprocket").read(sprocketTable());
  spec.roadWheel = root.section("road_wheel").read(roadWheelTable());
  spec.arm = root.section("arm").read(armTable());
  if (root.has("engine")) spec.engine = root.section("engine").read(engineTable());
  if (root.has("shapes")) spec.shapes = root.section("shapes").read(shapesTable());
  if (root.has("roller")) spec.roller = root.section("roller").read(rollerTable());
  spec.idler = root.section("idler").read(idlerTable());
  spec.contact = root.section("contact").read(contactTable());
  return spec;
}

VehicleSpec sectionsOf(const base::Section& root) {
  try {
    return readSections(root);
  } catch (const base::UnknownKey& unknown) {
    throw base::amongAllKeys(unknown, specKeys());
  }
}

} // namespace

VehicleSpec readVehicleSpec(const SpecSource& source) {
  const base::Document document = documentOf(source);
  const base::Section root = document.root();
  VehicleSpec spec = sectionsOf(root);
  checkTogether(root, spec);
  if (const std::optional<SpecFault> fault = runningGearFault(spec))
    root.section(fault->section).fail(fault->key, fault->message);
  // The mesh folder is relative to the spec file.
  spec.meshFolder = (std::filesystem::path(source.file).parent_path() / spec.meshFolder).lexically_normal().string();
  return spec;
}

std::vector<base::UnusualValue> unusualSpecValues(const SpecSource& source) {
  const base::Document document = documentOf(source);
  sectionsOf(document.root());
  return document.unusual();
}

void refuse(const SpecSource& source, const SpecFault& fault) {
  const base::Document document = documentOf(source);
  document.root().section(fault.section).fail(fault.key, fault.message);
}

void refuseMesh(const SpecSource& source, const std::string& section, const std::string& why) {
  refuse(source, {section, "mesh", "in vehicle.mesh_folder (relative to this file) is not a usable mesh: " + why});
}

std::vector<SpecSection> specSections() {
  const auto of = [](const auto& table) { return SpecSection{table.name(), table.fields()}; };
  return {of(vehicleTable()),   of(chassisTable()), of(shoeTable()),   of(sprocketTable()),
          of(roadWheelTable()), of(armTable()),     of(rollerTable()), of(idlerTable()),
          of(contactTable()),   of(engineTable()),  of(shapesTable())};
}

std::vector<std::string> specKeys(const std::string& before) {
  std::vector<std::string> keys;
  for (const SpecSection& section : specSections())
    for (const base::Field& field : section.fields) keys.push_back(before + section.name + "." + field.key);
  return keys;
}

std::string specFieldHelp() {
  std::string text = R"(## Keys of a vehicle file

The key `vehicle.spec` of a scene names this file. A scene, `--set` and sweeps can change each key for a run, with
`spec.` before it: `[spec.shoe]` with `pin_damping = 10.0`, or `--set spec.shoe.pin_damping=10`. The file begins with
`version = 1`; all sections but [roller], [engine] and [shapes] are required. SI units, angles in radians. Axes: x
forward, y left, z up; origin: the middle of the sprockets' axle line. The two tracks are identical. Inertia is about a
part's centre of mass, along the axes of its frame.

A mesh is closed, its triangles face outward, its vertices are in metres in the frame of its part:

- chassis: the vehicle's frame, origin in the middle of the sprockets' axle line;
- shoe: origin in the middle between its two pin axes, x along the track, forward in ground contact, z towards the
  inside of the loop: its pins lie at x = +- pitch / 2, z = 0;
- sprocket, road wheel, roller, idler: origin on the axle, y along it; gap k of the sprocket at the angle
  2 pi k / teeth from +x towards +z, so deep that pins seat at the radius pitch / (2 sin(pi / teeth)).
)";
  const std::string tables[] = {
      base::describe(vehicleTable()),  base::describe(chassisTable()),   base::describe(shoeTable()),
      base::describe(sprocketTable()), base::describe(roadWheelTable()), base::describe(armTable()),
      base::describe(rollerTable()),   base::describe(idlerTable()),     base::describe(contactTable()),
      base::describe(engineTable()),   base::describe(shapesTable())};
  for (const std::string& table : tables) text.append("\n").append(table);
  return text;
}

} // namespace grouser::vehicle

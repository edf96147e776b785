// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [vehicle], [driver] and [driver.table].
#include "runs/scene/detail/section_lists.hpp"

#include "runs/scene/detail/section_checks.hpp"

#include "base/rounded.hpp"
#include "multibody/time_law.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

Table<Vehicle> vehicleTable() {
  using S = Vehicle;
  Table<S> t("vehicle", "Tracked vehicle");
  t.add("spec", &S::spec, "",
        "vehicle file (keys: grouser fields --vehicle); searched for in the scene's folder, the working folder and the "
        "assets folder")
      .required();
  t.add("position", &S::position, "m",
        "initial x and y of the point midway between the sprockets; \"auto\": rear of the vehicle at the border of the "
        "terrain, middle across the heading")
      .plausible(0, 5000)
      .atLeast(-1e6)
      .atMost(1e6)
      .orWord("auto");
  t.add("heading", &S::heading, "deg", "heading from the x axis, counter-clockwise seen from above, in degrees")
      .plausible(1, 360)
      .atLeast(-360)
      .atMost(360);
  t.add("clearance", &S::clearance, "m", "initial gap between the lowest grouser and the highest ground below")
      .plausible(0, 1)
      .atLeast(0)
      .atMost(10);
  t.add("sphere_radius", &S::sphereRadius, "m",
        "radius of the spheres that represent the parts in contacts; \"auto\": 0.02, or less if spheres would protrude "
        "by more than a twentieth of the smallest grain radius or of a quarter of the pitch")
      .plausible(1e-3, 0.3)
      .above(0)
      .atMost(1)
      .orWord("auto");
  t.add("sphere_refinement", &S::sphereRefinement, "-",
        "divisor of all sphere radii and of automatic protrusion limits; grouser check doubles this divisor in its "
        "finer case")
      .atLeast(1)
      .atMost(16);
  t.add("material", &S::material, "",
        "material of the parts in contact with grains and (friction only) obstacles; default: the material of the "
        "contact partner, with friction_ground of the vehicle file and the adhesion set by adhesion; on rigid ground "
        "the vehicle file defines all contact parameters");
  t.add("adhesion", &S::adhesion, "-",
        "adhesive force between parts without a material and cohesive grains, relative to a wall of the soil material "
        "(the adhesive force of such a wall is 4 times that between equal grains, or twice if adhesion_radius is not "
        "set); 0: no adhesion")
      .atLeast(0)
      .atMost(1);
  t.add("chassis", &S::chassis, "",
        "constraint of the hull: free; fixed (test bench); guided (on rails along the heading, free to heave and "
        "pitch); level (guided without pitch)");
  t.add("tracks", &S::tracks, "",
        "number of tracks: both, or single (one track in the middle of the hull, as on a test rig; requires chassis = "
        "\"guided\", \"level\" or \"fixed\"). The hull mass is unchanged; in results, this track is the left one");
  t.add("soil_contact", &S::soilContact, "",
        "parts of the vehicle with soil contact: all (the hull if hull_touches) or shoes only, which prevents grains "
        "from being pinched between running gear and track; all results state this setting")
      .formerly("soil_meets");
  t.add("gear_contact_model", &S::gearContactModel, "",
        "contact geometry of shoes with wheels, sprocket, rigid ground and obstacles: \"shapes\" (dimensions in "
        "[shapes] of the vehicle file), \"samples\" (points on the meshes) or \"auto\" (shapes if the file has them)")
      .orWord("auto");
  t.add("hull_sphere_radius", &S::hullSphereRadius, "m",
        "radius of the spheres that represent the hull in contacts, if it has any; \"auto\": 0.02, or sphere_radius if "
        "larger")
      .plausible(1e-3, 0.5)
      .above(0)
      .atMost(1)
      .orWord("auto");
  t.add("hull_touches", &S::hullTouches, "",
        "whether the hull has contact with the ground and with fixed surfaces, as the shoes have; \"auto\": on rigid "
        "ground and in scenes with fixed surfaces, but not in scenes with grains only, where it costs time")
      .orWord("auto");
  return t;
}

Table<Driver> driverTable() {
  using S = Driver;
  Table<S> t("driver", "Sprocket drive and start sequence (track tension, weight, drive)");
  t.add("drive", &S::drive, "",
        "type of sprocket drive: speed (imposed, at any torque), torque (imposed), or engine (engines of the vehicle "
        "file with governors that control the speeds)");
  t.add("sprocket_speed", &S::sprocketSpeed, "rad/s",
        "speed of both sprockets, positive forward; default: 0 if no speed is set")
      .plausible(0, 60)
      .atLeast(-100)
      .atMost(100);
  t.add("left", &S::left, "rad/s", "speed of the left sprocket; requires right")
      .plausible(0, 60)
      .atLeast(-100)
      .atMost(100);
  t.add("right", &S::right, "rad/s", "speed of the right sprocket; requires left")
      .plausible(0, 60)
      .atLeast(-100)
      .atMost(100);
  t.add("torque", &S::torque, "N m", "torque on each sprocket, positive forward")
      .plausible(0, 1e5)
      .atLeast(-1e7)
      .atMost(1e7);
  t.add("left_torque", &S::leftTorque, "N m", "torque on the left sprocket; requires right_torque")
      .plausible(0, 1e5)
      .atLeast(-1e7)
      .atMost(1e7);
  t.add("right_torque", &S::rightTorque, "N m", "torque on the right sprocket; requires left_torque")
      .plausible(0, 1e5)
      .atLeast(-1e7)
      .atMost(1e7);
  t.add("tension_ramp", &S::tensionRamp, "s", "ramp duration of the idler spring forces (track tension)")
      .plausible(0, 20)
      .atLeast(0)
      .atMost(1e3);
  t.add("weight_ramp", &S::weightRamp, "s",
        "ramp duration of the vehicle's weight and the preload of the suspension arms, after tension_ramp")
      .plausible(0, 30)
      .atLeast(0)
      .atMost(1e3);
  t.add("drive_start", &S::driveStart, "s",
        "start time of the sprockets; \"auto\": when the vehicle has come to rest after weight_ramp, or at the end of "
        "weight_ramp if the hull is fixed")
      .plausible(0, 300)
      .atLeast(0)
      .atMost(1e5)
      .orWord("auto");
  t.add("drive_ramp", &S::driveRamp, "s",
        "ramp duration of the sprocket speeds; \"auto\": 0.3 for constant speeds, 0 for a table")
      .plausible(0, 60)
      .atLeast(0)
      .atMost(1e3)
      .orWord("auto");
  t.add("rest_speed", &S::restSpeed, "m/s", "criterion of rest: maximum vertical speed of the vehicle")
      .above(0)
      .atMost(10);
  t.add("rest_load", &S::restLoad, "-",
        "criterion of rest: maximum relative difference between ground force and weight")
      .above(0)
      .atMost(0.5);
  t.add("rest_time_limit", &S::restTimeLimit, "s",
        "time limit after weight_ramp; a vehicle that is not at rest by then ends the run with an error")
      .plausible(0, 100)
      .above(0)
      .atMost(1e4);
  return t;
}

Table<SpeedTable> speedTable() {
  using S = SpeedTable;
  Table<S> t("driver.table", "Sprocket speeds over time, instead of constant speeds; interpolated linearly");
  t.add("time", &S::time, "s", "times after drive_start, in increasing order; a repeated time defines a jump")
      .plausible(0, 3600)
      .atLeast(0)
      .required();
  t.add("left", &S::left, "rad/s", "speed of the left sprocket at these times")
      .plausible(0, 60)
      .atLeast(-100)
      .atMost(100)
      .required();
  t.add("right", &S::right, "rad/s", "speed of the right sprocket at these times")
      .plausible(0, 60)
      .atLeast(-100)
      .atMost(100)
      .required();
  return t;
}

Table<TorqueTable> torqueTable() {
  using S = TorqueTable;
  Table<S> t("driver.torques", "Sprocket torques over time, instead of constant torques; interpolated linearly");
  t.add("time", &S::time, "s", "times after drive_start, in increasing order; a repeated time defines a jump")
      .plausible(0, 3600)
      .atLeast(0)
      .required();
  t.add("left", &S::left, "N m", "torque on the left sprocket at these times")
      .plausible(0, 1e5)
      .atLeast(-1e7)
      .atMost(1e7)
      .required();
  t.add("right", &S::right, "N m", "torque on the right sprocket at these times")
      .plausible(0, 1e5)
      .atLeast(-1e7)
      .atMost(1e7)
      .required();
  return t;
}

Table<Course> courseTable() {
  using S = Course;
  Table<S> t("driver.course",
             "Closed-loop control: sets the sprocket speeds so that the hull maintains a target speed and "
             "follows a circle or path");
  t.add("speed", &S::speed, "m/s",
        "target hull speed at the middle of the track-ground contact length; negative: backwards")
      .plausible(0, 20)
      .atLeast(-50)
      .atMost(50)
      .required();
  t.add("acceleration", &S::acceleration, "m/s2", "acceleration at the start and deceleration at the end of a path")
      .plausible(0.01, 10)
      .above(0)
      .atMost(100);
  t.add("radius", &S::radius, "m",
        "radius of a circle, positive to the left, instead of a path; default: straight ahead")
      .plausible(0.5, 1000)
      .atLeast(-1e6)
      .atMost(1e6);
  t.add("x", &S::x, "m", "x of the corners of a path; the vehicle stops at the last one")
      .plausible(0, 5000)
      .atLeast(-1e6)
      .atMost(1e6);
  t.add("y", &S::y, "m", "y of the corners of a path").plausible(0, 5000).atLeast(-1e6).atMost(1e6);
  t.add("look_ahead", &S::lookAhead, "m",
        "look-ahead distance on the path; \"auto\": distance from the first to the last road wheel")
      .plausible(0.05, 50)
      .above(0)
      .atMost(1e3)
      .orWord("auto");
  t.add("speed_gain", &S::speedGain, "-", "proportional gain for the speed error").atLeast(0).atMost(100);
  t.add("speed_integral", &S::speedIntegral, "1/s", "integral gain for the speed error").atLeast(0).atMost(1e3);
  t.add("turn_gain", &S::turnGain, "-", "proportional gain for the yaw-rate error").atLeast(0).atMost(100);
  t.add("turn_integral", &S::turnIntegral, "1/s", "integral gain for the yaw-rate error").atLeast(0).atMost(1e3);
  t.add("max_sprocket_speed", &S::maxSprocketSpeed, "rad/s", "maximum sprocket speed in closed loop")
      .above(0)
      .atMost(100)
      .formerly("most_speed");
  return t;
}

Table<Stop> stopTable() {
  using S = Stop;
  Table<S> t("stop", "Conditions that end a run with a vehicle before run.duration (exit code 0)");
  t.add("distance", &S::distance, "m", "maximum horizontal distance from the initial position; default: no limit")
      .plausible(0.01, 5000)
      .above(0)
      .atMost(1e6);
  t.add("edge", &S::edge, "m",
        "minimum distance between the middle of a shoe and the edge of the terrain; default: the run ends with an "
        "error if a shoe leaves the terrain")
      .plausible(0, 10)
      .atLeast(0)
      .atMost(1e6);
  t.add("immobile", &S::immobile, "s",
        "maximum time in which the hull moves slower than a twentieth of the speed of the driven tracks; default: no "
        "limit")
      .plausible(0.01, 60)
      .above(0)
      .atMost(1e5);
  return t;
}

void checkStop(const Section& section, Stop& s, const Scene& scene) {
  if (!scene.vehicle) section.fail("", "requires a vehicle; add a section [vehicle], or remove this section");
  if (s.edge && !scene.terrain)
    section.fail("edge", "[m] has no effect without terrain; add a section [terrain], or remove it");
  if (scene.vehicle->chassis == ChassisMount::fixed)
    section.fail("", "has no effect on a vehicle with a fixed hull; set vehicle.chassis = \"free\", or remove it");
}

void checkVehicle(const Section& section, Vehicle& v, const Scene& scene) {
  if (!v.material.empty()) {
    requireMaterial(scene, section, "material", v.material);
    if (v.adhesion > 0)
      section.fail("adhesion",
                   fmt::format("applies to parts without a material, but vehicle.material is \"{0}\"; remove material, "
                               "or remove adhesion and set cohesion in [contact.\"SOIL|{0}\"] instead",
                               v.material));
  }
  resolveFile(scene, section, "spec", v.spec);
  if (v.tracks != Tracks::both && v.chassis == ChassisMount::free)
    section.fail("tracks", "is \"single\", but a free hull on one track tips over; set vehicle.chassis = \"guided\" or "
                           "\"level\", or tracks = \"both\"");
  const bool hasGround = scene.terrain || !scene.planes.empty();
  if (!hasGround && v.chassis != ChassisMount::fixed)
    section.fail("chassis", "is \"free\" without ground; add [terrain] or [[plane]], or set chassis = \"fixed\"");
  if (v.position && scene.terrain) {
    const auto [sizeX, sizeY] = scene.terrain->size;
    const auto [x, y] = *v.position;
    if (x < 0 || x > sizeX || y < -sizeY / 2 || y > sizeY / 2)
      section.fail("position",
                   fmt::format("[m] is outside the terrain, x in [0, {}], y in [{}, {}]; place the vehicle on it",
                               sizeX, -sizeY / 2, sizeY / 2));
  }
}

void checkTorques(const Section& section, const Driver& d) {
  const bool torques = d.torque || d.leftTorque || d.rightTorque || section.has("torques");
  const bool speeds = d.sprocketSpeed || d.left || section.has("table");
  const char* given = d.torque ? "torque" : d.leftTorque ? "left_torque" : d.rightTorque ? "right_torque" : "torques";
  if (torques && d.drive != vehicle::SprocketDrive::torque)
    section.fail(given, "[N m] requires driver.drive = \"torque\"; set it, or remove the key");
  if (speeds && d.drive == vehicle::SprocketDrive::torque)
    section.fail(d.sprocketSpeed ? "sprocket_speed"
                 : d.left        ? "left"
                                 : "table",
                 "[rad/s] is incompatible with driver.drive = \"torque\"; use torque, left_torque with right_torque, "
                 "or [driver.torques]");
  if (d.leftTorque.has_value() != d.rightTorque.has_value())
    section.fail(given, fmt::format("[N m] requires {}; set both, or only torque",
                                    d.leftTorque ? "right_torque" : "left_torque"));
  if ((d.torque ? 1 : 0) + (d.leftTorque ? 1 : 0) + (section.has("torques") ? 1 : 0) > 1)
    section.fail(given, "[N m] conflicts with another torque setting; keep only one of torque, left_torque with "
                        "right_torque, [driver.torques]");
  if (!section.has("course")) return;
  if (speeds)
    section.fail(d.sprocketSpeed ? "sprocket_speed"
                 : d.left        ? "left"
                                 : "table",
                 "[rad/s] is mutually exclusive with [driver.course]; remove one");
  if (d.drive == vehicle::SprocketDrive::torque)
    section.fail("drive", "is incompatible with [driver.course], which controls speeds; set it to \"speed\" or "
                          "\"engine\", or remove the course");
}

void checkCourse(const Section& section, Course& c, const Scene& scene) {
  if (scene.vehicle->tracks != Tracks::both)
    section.fail("", "requires two tracks, but vehicle.tracks = \"single\"; use sprocket_speed");
  if (scene.vehicle->chassis == ChassisMount::fixed)
    section.fail("", "requires a moving hull, but vehicle.chassis = \"fixed\"; change chassis, or use sprocket_speed");
  if (c.radius && *c.radius == 0) section.fail("radius", "[m] must not be 0; set it above 0 (left) or below 0 (right)");
  if (c.radius && !c.x.empty()) section.fail("radius", "[m] is mutually exclusive with a path (x, y); remove one");
  if (c.x.size() != c.y.size())
    section.fail(c.x.size() < c.y.size() ? "x" : "y",
                 fmt::format("[m] has {} entries, but the other coordinate has {}; set both for each corner",
                             std::min(c.x.size(), c.y.size()), std::max(c.x.size(), c.y.size())));
  if (c.x.size() == 1) section.fail("x", "[m] has only one corner; set at least two");
  for (std::size_t i = 1; i < c.x.size(); ++i)
    if (c.x[i] == c.x[i - 1] && c.y[i] == c.y[i - 1])
      section.fail("x", fmt::format("[m] and y contain the same corner at entries {} and {}; remove one", i - 1, i));
  if (!c.x.empty() && c.speed < 0) section.fail("speed", "[m/s] must be above 0 on a path");
}

void checkDriver(const Section& section, Driver& d, const Scene& scene) {
  constexpr double kTyped = 1e-9; // [s] rounding tolerance, since 0.1 + 0.2 differs from 0.3
  if (!scene.vehicle)
    section.fail("", "has no effect without a vehicle; add a section [vehicle], or remove this section");
  if (d.left.has_value() != d.right.has_value())
    section.fail(d.left ? "left" : "right",
                 fmt::format("[rad/s] requires {}; set both, or only sprocket_speed", d.left ? "right" : "left"));
  if ((d.sprocketSpeed ? 1 : 0) + (d.left ? 1 : 0) + (section.has("table") ? 1 : 0) > 1)
    section.fail(d.sprocketSpeed ? "sprocket_speed" : "left", "[rad/s] conflicts with another speed setting; keep only "
                                                              "one of sprocket_speed, left with right, [driver.table]");
  checkTorques(section, d);
  if (const double ramps = d.tensionRamp + d.weightRamp; d.driveBegins() < ramps - kTyped)
    section.fail("drive_start",
                 fmt::format("[s] is before the end of the ramps, driver.tension_ramp + driver.weight_ramp = {:.6g} s; "
                             "set it to {} or more, or \"auto\", or shorten the ramps",
                             ramps, base::roundedUp(ramps, 6)));
}

/// Checks a table of speeds or torques.
template <class Sides> void checkSides(const Section& section, Sides& table, const char* unit) {
  const std::size_t n = table.time.size();
  if (n == 0) section.fail("time", "[s] is empty; set at least one time");
  if (table.left.size() != n || table.right.size() != n)
    section.fail(table.left.size() != n ? "left" : "right",
                 fmt::format("[{}] must have as many entries as time ({}); correct the lists", unit, n));
  if (const std::size_t i = multibody::firstOutOfOrder(table.time, true); i > 0)
    section.fail("time", fmt::format("[s] must increase, but does not at entry {}; sort the list", i));
}

void checkSpeeds(const Section& section, SpeedTable& table, const Scene&) { checkSides(section, table, "rad/s"); }
void checkTorqueTable(const Section& section, TorqueTable& table, const Scene&) { checkSides(section, table, "N m"); }

/// [spec.SECTION]: keys of the vehicle file. Reading the vehicle file checks their combinations.
void readSpecKeys(const Section& root, Scene& scene) {
  if (!root.has("spec")) return;
  const Section spec = root.section("spec");
  if (!scene.vehicle)
    spec.fail("", "has no effect without a vehicle file; add a section [vehicle], or remove this section");
  const std::vector<vehicle::SpecSection> sections = vehicle::specSections();
  std::vector<std::string> names;
  for (const vehicle::SpecSection& s : sections) names.push_back(s.name);
  spec.allowOnly(names);
  for (const vehicle::SpecSection& s : sections) {
    if (!spec.has(s.name)) continue;
    const Section section = spec.section(s.name);
    std::vector<std::string> keys;
    for (const base::Field& field : s.fields) keys.push_back(field.key);
    section.allowOnly(keys);
    for (const base::Field& field : s.fields)
      if (const base::Node* node = section.node().find(field.key))
        scene.vehicle->specKeys.push_back({s.name, field.key, *node, base::toToml(section.value(field))});
  }
}

std::string writeSpecKeys(const Scene& scene) {
  std::string text, section;
  if (!scene.vehicle) return text;
  for (const vehicle::SpecKey& k : scene.vehicle->specKeys) {
    if (k.section != section) text += fmt::format("\n[spec.{}]\n", k.section);
    section = k.section;
    text += fmt::format("{} = {}\n", k.key, k.text);
  }
  return text;
}

SectionEntry specEntry() {
  return {"spec",
          readSpecKeys,
          writeSpecKeys,
          [] {
            return std::string(
                "### `[spec.SECTION]`\n\nKeys of the vehicle file (below) that replace its values, in the same "
                "sections: `[spec.shoe]` with\n`pin_damping = 10.0`, or `--set spec.shoe.pin_damping=10`.\n");
          },
          [](base::Document&) {},
          vehicle::specKeys("spec.")};
}

bool hasVehicle(const Scene& scene) { return scene.vehicle.has_value(); }

} // namespace

SectionList vehicleSections() {
  const auto table = [](auto& scene) -> auto& { return scene.driver.table; };
  const auto torques = [](auto& scene) -> auto& { return scene.driver.torqueTable; };
  const auto course = [](auto& scene) -> auto& { return scene.driver.course; };
  return {optional("vehicle", &Scene::vehicle, vehicleTable(), checkVehicle),
          specEntry(),
          single("driver", &Scene::driver, driverTable(), checkDriver, {"table", "torques", "course"})
              .writtenIf(hasVehicle),
          optional("driver.table", table, speedTable(), checkSpeeds).writtenIf(hasVehicle),
          optional("driver.torques", torques, torqueTable(), checkTorqueTable).writtenIf(hasVehicle),
          optional("driver.course", course, courseTable().leaveOutEmpty(), checkCourse).writtenIf(hasVehicle),
          single("stop", &Scene::stop, stopTable(), checkStop).writtenIf(hasVehicle)};
}

} // namespace grouser::scene::detail

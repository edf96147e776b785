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
  Table<S> t("vehicle", "A tracked vehicle");
  t.add("spec", &S::spec, "",
        "vehicle file (its keys: grouser fields --vehicle); looked for in the scene's folder, the working folder, the "
        "assets folder")
      .required();
  t.add("position", &S::position, "m",
        "x and y of the point between the sprockets; \"auto\" is on the terrain's near end")
      .atLeast(-1e6)
      .atMost(1e6)
      .orWord("auto");
  t.add("heading", &S::heading, "deg", "from the x axis, counter-clockwise seen from above").atLeast(-360).atMost(360);
  t.add("clearance", &S::clearance, "m", "between lowest grouser and highest ground below at the start")
      .atLeast(0)
      .atMost(10);
  t.add("sphere_radius", &S::sphereRadius, "m",
        "of the parts' sphere sets; \"auto\": 0.02, or finer for parts of which these would stand out by more than a "
        "twentieth of the smallest grain's radius or of a quarter of the pitch")
      .above(0)
      .atMost(1)
      .orWord("auto");
  t.add(
       "sphere_refinement", &S::sphereRefinement, "-",
       "divides all sphere radii, and of automatic ones the permitted protrusion too; grouser check doubles it for its "
       "finer case")
      .atLeast(1)
      .atMost(16);
  t.add("material", &S::material, "",
        "of the parts against grains and, for friction, obstacles; where not given they are of the other's own "
        "material, but with friction_ground of the vehicle file and the pull that adhesion says; on rigid ground all "
        "contact data are the vehicle file's");
  t.add("adhesion", &S::adhesion, "-",
        "of parts without a material: how strongly they pull on cohesive grains, as a share of what a wall of the "
        "soil's own material does, which is 4 times the pull of an equal grain (twice without adhesion_radius); 0 lets "
        "soil fall off")
      .atLeast(0)
      .atMost(1);
  t.add(
      "chassis", &S::chassis, "",
      "free to move; held in place as on a bench; or on rails along the heading: \"guided\", it moves along, rises and "
      "pitches, \"level\", it does not pitch");
  t.add("tracks", &S::tracks, "",
        "both, or a single one in the middle of the hull, as on a test rig: that wants chassis = \"guided\", \"level\" "
        "or "
        "\"fixed\". The hull weighs what the vehicle file says; results are under left");
  t.add("soil_contact", &S::soilContact, "",
        "parts of the vehicle that touch grains: all (the hull if hull_touches) or the shoes only, so that no grain is "
        "pinched between running gear and track; named in all results")
      .formerly("soil_meets");
  t.add("gear_contact_model", &S::gearContactModel, "",
        "contact geometry of shoes with wheels, sprocket, rigid ground and obstacles: \"shapes\", the dimensions in "
        "[shapes] of the vehicle file; \"samples\", points on the meshes; \"auto\": shapes if the file has them")
      .orWord("auto");
  t.add("hull_sphere_radius", &S::hullSphereRadius, "m",
        "of the hull's sphere set, where it touches something; \"auto\": 0.02, or sphere_radius where that is more")
      .above(0)
      .atMost(1)
      .orWord("auto");
  t.add("hull_touches", &S::hullTouches, "",
        "whether the hull meets the ground and the surfaces at rest, as shoes do; \"auto\": on rigid ground, and where "
        "the scene has such surfaces; not on grains alone, where it costs time")
      .orWord("auto");
  return t;
}

Table<Driver> driverTable() {
  using S = Driver;
  Table<S> t("driver", "What the sprockets are given, and the order of the start: tension, weight, drive");
  t.add("drive", &S::drive, "",
        "what the sprockets are given: speeds, whatever torque that takes; torques; or what the engines of the vehicle "
        "file give, whose governors hold the speeds");
  t.add("sprocket_speed", &S::sprocketSpeed, "rad/s",
        "of both sprockets; positive drives forward; 0 where no speed is given")
      .atLeast(-100)
      .atMost(100);
  t.add("left", &S::left, "rad/s", "of the left sprocket, together with right").atLeast(-100).atMost(100);
  t.add("right", &S::right, "rad/s", "of the right sprocket, together with left").atLeast(-100).atMost(100);
  t.add("torque", &S::torque, "N m", "on each sprocket; positive drives forward").atLeast(-1e7).atMost(1e7);
  t.add("left_torque", &S::leftTorque, "N m", "on the left sprocket, together with right_torque")
      .atLeast(-1e7)
      .atMost(1e7);
  t.add("right_torque", &S::rightTorque, "N m", "on the right sprocket, together with left_torque")
      .atLeast(-1e7)
      .atMost(1e7);
  t.add("tension_ramp", &S::tensionRamp, "s", "over which the idlers' springs come on").atLeast(0).atMost(1e3);
  t.add("weight_ramp", &S::weightRamp, "s", "over which gravity and the arms' preload come on, then")
      .atLeast(0)
      .atMost(1e3);
  t.add("drive_start", &S::driveStart, "s",
        "when the sprockets begin to turn; \"auto\": when the vehicle rests after the weight's ramp, or at its end "
        "where "
        "the hull is fixed")
      .atLeast(0)
      .atMost(1e5)
      .orWord("auto");
  t.add("drive_ramp", &S::driveRamp, "s",
        "over which the sprockets come up to speed; \"auto\": 0.3 of constant speeds, 0 of a table, which is followed "
        "as it is given")
      .atLeast(0)
      .atMost(1e3)
      .orWord("auto");
  t.add("rest_speed", &S::restSpeed, "m/s", "a vehicle that rests moves up and down no faster than this")
      .above(0)
      .atMost(10);
  t.add("rest_load", &S::restLoad, "-", "and the ground carries its weight to within this share").above(0).atMost(0.5);
  t.add("rest_time_limit", &S::restTimeLimit, "s", "after the weight's ramp, by which it must rest; else the run ends")
      .above(0)
      .atMost(1e4);
  return t;
}

Table<SpeedTable> speedTable() {
  using S = SpeedTable;
  Table<S> t("driver.table", "Sprocket speeds over time, instead of fixed ones; linear between the points");
  t.add("time", &S::time, "s", "from the start of the drive (drive_start), increasing; a time given twice is a jump")
      .atLeast(0)
      .required();
  t.add("left", &S::left, "rad/s", "left sprocket at these times").atLeast(-100).atMost(100).required();
  t.add("right", &S::right, "rad/s", "right sprocket at these times").atLeast(-100).atMost(100).required();
  return t;
}

Table<TorqueTable> torqueTable() {
  using S = TorqueTable;
  Table<S> t("driver.torques", "Sprocket torques over time, instead of fixed ones; linear between the points");
  t.add("time", &S::time, "s", "from the start of the drive (drive_start), increasing; a time given twice is a jump")
      .atLeast(0)
      .required();
  t.add("left", &S::left, "N m", "left sprocket at these times").atLeast(-1e7).atMost(1e7).required();
  t.add("right", &S::right, "N m", "right sprocket at these times").atLeast(-1e7).atMost(1e7).required();
  return t;
}

Table<Course> courseTable() {
  using S = Course;
  Table<S> t("driver.course",
             "Closed loop: the hull's speed is held, and a circle or a path of points, by the speeds of "
             "both sprockets");
  t.add("speed", &S::speed, "m/s", "of the hull, at the middle of the ground run; backwards below 0")
      .atLeast(-50)
      .atMost(50)
      .required();
  t.add("acceleration", &S::acceleration, "m/s2", "at which it is taken up, and given up at the end of a path")
      .above(0)
      .atMost(100);
  t.add("radius", &S::radius, "m", "of a circle, to the left positive, instead of a path; straight on without both")
      .atLeast(-1e6)
      .atMost(1e6);
  t.add("x", &S::x, "m", "corners of a path, along which the vehicle drives to the last").atLeast(-1e6).atMost(1e6);
  t.add("y", &S::y, "m", "corners of a path").atLeast(-1e6).atMost(1e6);
  t.add("look_ahead", &S::lookAhead, "m",
        "how far ahead on the path the point lies that it steers to; \"auto\": as far as from first to last road wheel")
      .above(0)
      .atMost(1e3)
      .orWord("auto");
  t.add("speed_gain", &S::speedGain, "-", "of the error of speed").atLeast(0).atMost(100);
  t.add("speed_integral", &S::speedIntegral, "1/s", "of its integral").atLeast(0).atMost(1e3);
  t.add("turn_gain", &S::turnGain, "-", "of the error of the rate of turn").atLeast(0).atMost(100);
  t.add("turn_integral", &S::turnIntegral, "1/s", "of its integral").atLeast(0).atMost(1e3);
  t.add("max_sprocket_speed", &S::maxSprocketSpeed, "rad/s", "limit of the sprocket speed in closed loop")
      .above(0)
      .atMost(100)
      .formerly("most_speed");
  return t;
}

Table<Stop> stopTable() {
  using S = Stop;
  Table<S> t("stop", "What ends a run with a vehicle before run.duration, in order, with exit code 0");
  t.add("distance", &S::distance, "m", "level distance from where it was set down; not asked where not given")
      .above(0)
      .atMost(1e6);
  t.add("edge", &S::edge, "m",
        "between the middle of a shoe and the end of the terrain; where not given a shoe that leaves it is an error")
      .atLeast(0)
      .atMost(1e6);
  t.add("immobile", &S::immobile, "s",
        "for which driven tracks move the hull at less than a twentieth of their speed; not asked where not given")
      .above(0)
      .atMost(1e5);
  return t;
}

void checkStop(const Section& section, Stop& s, const Scene& scene) {
  if (!scene.vehicle) section.fail("", "needs a vehicle; add a section [vehicle], or remove this one");
  if (s.edge && !scene.terrain)
    section.fail("edge", "[m] has no meaning without terrain; add a section [terrain], or remove it");
  if (scene.vehicle->chassis == ChassisMount::fixed)
    section.fail("", "has no meaning for a vehicle that is held; set vehicle.chassis = \"free\", or remove it");
}

void checkVehicle(const Section& section, Vehicle& v, const Scene& scene) {
  if (!v.material.empty()) {
    requireMaterial(scene, section, "material", v.material);
    if (v.adhesion > 0)
      section.fail("adhesion", fmt::format("is that of parts without a material, and vehicle.material is \"{0}\"; "
                                           "remove material, or remove adhesion, and set cohesion in "
                                           "[contact.\"SOIL|{0}\"] instead",
                                           v.material));
  }
  resolveFile(scene, section, "spec", v.spec);
  if (v.tracks != Tracks::both && v.chassis == ChassisMount::free)
    section.fail("tracks",
                 "is a single one, and falls over where the hull is free; set vehicle.chassis = \"guided\" or "
                 "\"level\", or tracks = \"both\"");
  const bool hasGround = scene.terrain || !scene.planes.empty();
  if (!hasGround && v.chassis != ChassisMount::fixed)
    section.fail("chassis", "is \"free\" over no ground; add [terrain] or [[plane]], or set chassis = \"fixed\"");
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
    section.fail(given, "[N m] is given, and driver.drive does not drive by torques; set driver.drive = \"torque\", or "
                        "remove it");
  if (speeds && d.drive == vehicle::SprocketDrive::torque)
    section.fail(d.sprocketSpeed ? "sprocket_speed"
                 : d.left        ? "left"
                                 : "table",
                 "[rad/s] is given, and driver.drive = \"torque\" gives the sprockets torques; give torque, or "
                 "left_torque with right_torque, or [driver.torques]");
  if (d.leftTorque.has_value() != d.rightTorque.has_value())
    section.fail(given, fmt::format("[N m] stands without {}; give both, or torque alone",
                                    d.leftTorque ? "right_torque" : "left_torque"));
  if ((d.torque ? 1 : 0) + (d.leftTorque ? 1 : 0) + (section.has("torques") ? 1 : 0) > 1)
    section.fail(given, "[N m] is one of several torques given; keep one of torque, left_torque with right_torque, "
                        "[driver.torques]");
  if (!section.has("course")) return;
  if (speeds)
    section.fail(d.sprocketSpeed ? "sprocket_speed"
                 : d.left        ? "left"
                                 : "table",
                 "[rad/s] is given beside [driver.course], which finds the speeds; remove one of the two");
  if (d.drive == vehicle::SprocketDrive::torque)
    section.fail("drive", "gives the sprockets torques, and [driver.course] finds speeds; set it to \"speed\" or "
                          "\"engine\", or remove the course");
}

void checkCourse(const Section& section, Course& c, const Scene& scene) {
  if (scene.vehicle->tracks != Tracks::both)
    section.fail("", "steers by two tracks, and vehicle.tracks = \"single\"; give sprocket_speed");
  if (scene.vehicle->chassis == ChassisMount::fixed)
    section.fail("", "is for a hull that moves, and vehicle.chassis = \"fixed\"; free it, or give sprocket_speed");
  if (c.radius && *c.radius == 0) section.fail("radius", "[m] is no circle; give one above 0 (left) or below (right)");
  if (c.radius && !c.x.empty()) section.fail("radius", "[m] is given beside a path, x and y; keep one of the two");
  if (c.x.size() != c.y.size())
    section.fail(c.x.size() < c.y.size() ? "x" : "y",
                 fmt::format("[m] has {} entries, and the other coordinate {}; give both of each corner",
                             std::min(c.x.size(), c.y.size()), std::max(c.x.size(), c.y.size())));
  if (c.x.size() == 1) section.fail("x", "[m] is one corner alone, and no path; give two at least");
  for (std::size_t i = 1; i < c.x.size(); ++i)
    if (c.x[i] == c.x[i - 1] && c.y[i] == c.y[i - 1])
      section.fail("x", fmt::format("[m] and y name one corner twice, at entries {} and {}; remove one", i - 1, i));
  if (!c.x.empty() && c.speed < 0)
    section.fail("speed", "[m/s] is below 0, and a path is driven forwards; give one above 0");
}

void checkDriver(const Section& section, Driver& d, const Scene& scene) {
  constexpr double kTyped = 1e-9; // [s]: 0.1 and 0.2 are 0.3
  if (!scene.vehicle) section.fail("", "has nothing to drive; add a section [vehicle], or remove this one");
  if (d.left.has_value() != d.right.has_value())
    section.fail(d.left ? "left" : "right", fmt::format("[rad/s] stands without {}; give both, or sprocket_speed alone",
                                                        d.left ? "right" : "left"));
  if ((d.sprocketSpeed ? 1 : 0) + (d.left ? 1 : 0) + (section.has("table") ? 1 : 0) > 1)
    section.fail(d.sprocketSpeed ? "sprocket_speed" : "left",
                 "[rad/s] is one of several speeds given; keep one of sprocket_speed, left with right, [driver.table]");
  checkTorques(section, d);
  if (const double ramps = d.tensionRamp + d.weightRamp; d.driveBegins() < ramps - kTyped)
    section.fail("drive_start",
                 fmt::format("[s] is before tension and weight are on, driver.tension_ramp + driver.weight_ramp = "
                             "{:.6g} s; set it to {} or more, or \"auto\", or shorten the ramps",
                             ramps, base::roundedUp(ramps, 6)));
}

/// Of speeds and torques alike.
template <class Sides> void checkSides(const Section& section, Sides& table, const char* unit) {
  const std::size_t n = table.time.size();
  if (n == 0) section.fail("time", "[s] is empty; give at least one time");
  if (table.left.size() != n || table.right.size() != n)
    section.fail(table.left.size() != n ? "left" : "right",
                 fmt::format("[{}] has another length than time, which has {}; make all three alike", unit, n));
  if (const std::size_t i = multibody::firstOutOfOrder(table.time, true); i > 0)
    section.fail("time", fmt::format("[s] does not increase at entry {}; sort it", i));
}

void checkSpeeds(const Section& section, SpeedTable& table, const Scene&) { checkSides(section, table, "rad/s"); }
void checkTorqueTable(const Section& section, TorqueTable& table, const Scene&) { checkSides(section, table, "N m"); }

/// [spec.SECTION]: keys of the vehicle file. What they mean together is judged where that file is read.
void readSpecKeys(const Section& root, Scene& scene) {
  if (!root.has("spec")) return;
  const Section spec = root.section("spec");
  if (!scene.vehicle)
    spec.fail("", "changes keys of a vehicle file, and there is none; add a section [vehicle], or remove this one");
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
                "### `[spec.SECTION]`\n\nKeys of the vehicle file with other values than there, by its own sections "
                "(below): `[spec.shoe]` with\n`pin_damping = 10.0`, or `--set spec.shoe.pin_damping=10`.\n");
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

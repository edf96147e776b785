// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [[body]], [[joint]], [[spring]], [[bushing]], [[drive]] and [[coupling]].
#include "runs/scene/detail/section_checks.hpp"
#include "runs/scene/detail/section_lists.hpp"
#include "spheredecomp/decompose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

Table<BodySection> bodyTable() {
  using S = BodySection;
  Table<S> t("[body]", "A rigid body of a mechanism");
  t.add("name", &S::name, "", "what joints and springs call it; \"world\" is the ground's").required();
  t.add("mass", &S::mass, "kg",
        "of a body with shapes the volume of these times density where not given; otherwise required unless the body "
        "is fixed")
      .above(0)
      .atMost(1e12);
  t.add("density", &S::density, "kg/m3",
        "of its shapes, instead of mass: mass and inertia are the sums over them, overlaps counted twice; that of the "
        "material where not given")
      .above(0)
      .atMost(1e6);
  t.add("inertia", &S::inertia, "kg m2",
        "about the centre of mass in the body's axes: xx, yy, zz, or these with the entries xy, xz, yz of the matrix; "
        "of a uniform box, or of the shapes filled uniformly, where not given");
  t.add("box", &S::box, "m", "edges of the box that is drawn; without one it follows from mass and inertia")
      .above(0)
      .atMost(1e5);
  t.add("position", &S::position, "m", "of the centre of mass at the start").atLeast(-1e6).atMost(1e6);
  t.add("axis", &S::axis, "-", "about which the body's axes are turned from the world's, with angle");
  t.add("angle", &S::angle, "deg", "of that turn, right-handed").atLeast(-3600).atMost(3600);
  t.add("orientation", &S::orientation, "-",
        "unit quaternion w, x, y, z from body to world, instead of axis and angle");
  t.add("velocity", &S::velocity, "m/s", "of the centre of mass at the start, world components");
  t.add("spin", &S::spin, "rad/s", "angular velocity at the start, world components");
  t.add("fixed", &S::fixed, "", "never moves");
  t.add("point", &S::point, "", "a mass without extent or inertia, for spherical and distance joints and springs");
  t.add("material", &S::material, "", "name of the material of its shapes; required with [[body.shape]]");
  t.add("probe_size", &S::probe, "m",
        "edges of a box in the body's frame; the mass of the grains with centres within is recorded as grain_mass")
      .above(0)
      .atMost(1e5);
  t.add("probe_position", &S::probePosition, "m", "of the centre of that box, in the body's frame");
  return t;
}

Table<ShapeSection> shapeTable() {
  using S = ShapeSection;
  Table<S> t("[body.shape]", "Surface by which the body above it touches grains; a body may have several");
  t.add("kind", &S::kind, "", "sphere, box, cylinder, capsule, cone or mesh").required();
  t.add("size", &S::size, "m", "edges of a box").above(0).atMost(1e5);
  t.add("radius", &S::radius, "m", "of a sphere, cylinder or capsule; of a cone at its base").above(0).atMost(1e5);
  t.add("tip_radius", &S::tipRadius, "m", "of a truncated cone at its tip; 0 where not given").atLeast(0).atMost(1e5);
  t.add("length", &S::length, "m", "of a cylinder or cone; of a capsule without its caps").above(0).atMost(1e5);
  t.add(
      "file", &S::file, "",
      "of a mesh, OBJ, STL, PLY...: closed, outward; looked for in the scene's folder, the working folder, the assets "
      "folder");
  t.add("scale", &S::scale, "m", "of one unit of a mesh's file; 1 where not given").above(0).atMost(1e6);
  t.add(
       "sphere_radius", &S::sphereRadius, "m",
       fmt::format("of the spheres that a mesh is cut into, by which grains and points of other bodies touch it; where "
                   "not given {} of its diagonal, or finer where these would stand out of it by more than a fiftieth "
                   "of the smallest grain's radius or thickness",
                   MeshSection::kShareOfDiagonal))
      .atLeast(spheredecomp::kSmallestRadius)
      .atMost(spheredecomp::kLargestRadius);
  t.add("position", &S::position, "m",
        "of its centre (of a cone half-way up, of a mesh the file's origin), in the body's frame")
      .atLeast(-1e5)
      .atMost(1e5);
  t.add("axis", &S::axis, "-",
        "of a cylinder or capsule, of a cone from base to tip, in the body's frame, z where not given; with angle: "
        "about which a box or mesh is turned");
  t.add("angle", &S::angle, "deg", "of a box or mesh about axis, right-handed").atLeast(-3600).atMost(3600);
  return t;
}

Table<JointSection> jointTable() {
  using S = JointSection;
  Table<S> t("[joint]", "Holds two bodies together; what it leaves free is measured from the first to the second");
  t.add("name", &S::name, "", "what springs and drives call it").required();
  t.add("type", &S::type, "",
        "what stays free: one turn, all turns, two turns, a slide, turn and slide, nothing, or all "
        "but a distance");
  t.add("bodies", &S::bodies, "", "names of the two, e.g. [\"world\", \"rod\"]").required();
  t.add("point", &S::point, "m", "where it is at the start, in the world");
  t.add("axis", &S::axis, "-", "of turn or slide at the start, in the world; of a universal joint the first body's");
  t.add("second_axis", &S::secondAxis, "-", "of a universal joint, the second body's, perpendicular to axis");
  t.add("point_a", &S::pointA, "m", "instead of point: in the first body's frame, together with point_b");
  t.add("point_b", &S::pointB, "m", "the same in the second body's frame");
  t.add("axis_a", &S::axisA, "-", "instead of axis: in the first body's frame, together with axis_b");
  t.add("axis_b", &S::axisB, "-", "the same in the second body's frame; of a universal joint its own axis");
  t.add("length", &S::length, "m", "between point_a and point_b of a distance joint; as at the start where not given")
      .above(0)
      .atMost(1e5);
  t.add("damping", &S::damping, "N m s/rad or N s/m", "on the free axis; of a cylindrical joint on its angle")
      .atLeast(0);
  t.add("slide_damping", &S::slideDamping, "N s/m", "of a cylindrical joint on its slide").atLeast(0);
  t.add("limits", &S::limits, "rad or m", "end stops on the free axis, lower and upper, from its position 0");
  t.add("stop_stiffness", &S::stopStiffness, "N m/rad or N/m", "of the end stops; required with limits").atLeast(0);
  t.add("stop_damping", &S::stopDamping, "N m s/rad or N s/m",
        "of the end stops, which never pull: on the way out it takes at most what their springs give")
      .atLeast(0);
  return t;
}

Table<SpringSection> springTable() {
  using S = SpringSection;
  Table<S> t("[spring]", "Spring and damper between two points, or on the free axis of a joint");
  t.add("name", &S::name, "", "in results and messages").required();
  t.add("bodies", &S::bodies, "", "names of the two that it pushes apart; or joint");
  t.add("point_a", &S::pointA, "m", "its end on the first body, in that body's frame; (0, 0, 0) where not given");
  t.add("point_b", &S::pointB, "m", "its end on the second body, in that body's frame");
  t.add("joint", &S::joint, "",
        "name of a revolute, prismatic or cylindrical joint on whose axis it acts; instead of "
        "bodies");
  t.add("acts_on", &S::actsOn, "", "which axis of a cylindrical joint");
  t.add("stiffness", &S::stiffness, "N/m or N m/rad", "of the spring").atLeast(0);
  t.add("damping", &S::damping, "N s/m or N m s/rad", "of the damper; taken implicitly: any size is stable").atLeast(0);
  t.add("preload", &S::preload, "N or N m", "force at free_position, positive pushes apart");
  t.add("free_position", &S::freePosition, "m or rad",
        "length, or position of the axis, where only the preload acts; as at the start where not given");
  t.add("limits", &S::limits, "rad or m", "end stops on the axis of a joint, lower and upper");
  t.add("stop_stiffness", &S::stopStiffness, "N m/rad or N/m", "of the end stops; required with limits").atLeast(0);
  t.add("stop_damping", &S::stopDamping, "N m s/rad or N s/m",
        "of the end stops, which never pull: on the way out it takes at most what their springs give")
      .atLeast(0);
  return t;
}

Table<BushingSection> bushingTable() {
  using S = BushingSection;
  Table<S> t("[bushing]", "Elastic bearing: springs and dampers between two bodies in all six directions, relaxed at "
                          "the start");
  t.add("name", &S::name, "", "in results and messages").required();
  t.add("bodies", &S::bodies, "", "names of the two").required();
  t.add("point", &S::point, "m", "its middle at the start, in the world").required();
  t.add("axis", &S::axis, "-", "its z direction at the start, in the world; the world's axes where not given");
  t.add("stiffness", &S::stiffness, "N/m", "along its x, y, z").atLeast(0);
  t.add("damping", &S::damping, "N s/m", "along its x, y, z").atLeast(0);
  t.add("rotation_stiffness", &S::rotationStiffness, "N m/rad", "about its x, y, z").atLeast(0);
  t.add("rotation_damping", &S::rotationDamping, "N m s/rad", "about its x, y, z").atLeast(0);
  return t;
}

Table<DriveSection> driveTable() {
  using S = DriveSection;
  Table<S> t("[drive]", "Motor on a free axis of a joint: value, polynomial, sine and table over time add up; what it "
                        "takes is in the results");
  t.add("name", &S::name, "", "in results and messages").required();
  t.add("joint", &S::joint, "", "name of a revolute, prismatic or cylindrical joint").required();
  t.add("acts_on", &S::actsOn, "", "which axis of a cylindrical joint");
  t.add("imposes", &S::imposes, "", "speed or position of the axis, or the torque (of a slide the force)");
  t.add("value", &S::value, "rad/s, rad, N m or m/s, m, N", "at all times");
  t.add("polynomial", &S::polynomial, "of value over s^i", "c0, c1, c2... of c0 + c1 t + c2 t^2..., instead of value");
  t.add("amplitude", &S::amplitude, "as value", "of a sine");
  t.add("frequency", &S::frequency, "Hz", "of that sine").atLeast(0).atMost(1e6);
  t.add("phase", &S::phase, "deg", "of that sine at t = 0").atLeast(-3600).atMost(3600);
  t.add("time", &S::time, "s", "increasing; of the table; a time given twice is a jump, but for a position").atLeast(0);
  t.add("values", &S::values, "as value",
        "of the table: straight between its times for speed and torque, a smooth spline from rest to rest for a "
        "position; constant "
        "outside");
  return t;
}

Table<CouplingSection> couplingTable() {
  using S = CouplingSection;
  Table<S> t("[coupling]",
             "Ties two axes as gears, belts, rack and pinion or a screw do: position of the second = ratio x "
             "position of the first + offset");
  t.add("name", &S::name, "", "in results and messages").required();
  t.add("joints", &S::joints, "", "names of the two").required();
  t.add("ratio", &S::ratio, "-, m/rad or rad/m", "motion of the second axis over that of the first").required();
  t.add("offset", &S::offset, "rad or m", "as at the start where not given");
  t.add("acts_on", &S::actsOn, "", "for cylindrical joints: which axis of each, e.g. [\"angle\", \"slide\"]");
  return t;
}

/// Sections that a scene with bodies cannot have: those at all, and those where no body has a shape.
void checkCompany(const Section& section, const Scene& scene) {
  const Section root = scene.document->root();
  const auto touches = [](const Section& body) { return body.has("shape"); };
  const std::vector<Section> bodies = root.list("body");
  const bool anyTouches = std::any_of(bodies.begin(), bodies.end(), touches);
  for (const char* other : {"grain", "grains", "source", "plane", "box", "cylinder", "mesh", "terrain", "fluid"})
    if (root.has(other) && !anyTouches && !root.has("vehicle"))
      section.fail("", fmt::format("is incompatible with {}, since no body has a shape that could touch it; add "
                                   "[[body.shape]], or give the mechanism a scene of its own",
                                   other));
  const bool bed = scene.terrain && scene.terrain->granular();
  if (root.has("mesh") && (bed || root.has("grain") || root.has("grains") || root.has("source")))
    section.fail("", "is incompatible with mesh beside grains; use boxes and cylinders, or remove the grains");
}

void checkShape(const Section& section, const ShapeSection& s) {
  const bool isBox = s.kind == ShapeKind::box, isMesh = s.kind == ShapeKind::mesh;
  const bool isCone = s.kind == ShapeKind::cone;
  const bool isLong = s.kind == ShapeKind::cylinder || s.kind == ShapeKind::capsule || isCone;
  const std::string kind(base::wordOf(s.kind));
  const auto need = [&](bool needed, bool given, const char* key, const char* example) {
    if (needed && !given)
      section.fail(key, fmt::format("{}is missing, which a {} needs; add e.g. {}",
                                    key == std::string("file") ? "" : "[m] ", kind, example));
    if (!needed && given) section.fail(key, fmt::format("does not apply to a {}; remove it", kind));
  };
  need(isBox, s.size.has_value(), "size", "size = [0.2, 0.2, 0.1]");
  need(!isBox && !isMesh, s.radius.has_value(), "radius", "radius = 0.1");
  need(isLong, s.length.has_value(), "length", "length = 0.2");
  need(isMesh, s.file.has_value(), "file", "file = \"meshes/roller.obj\"");
  for (const auto& [given, key] :
       {std::pair{s.scale.has_value(), "scale"}, {s.sphereRadius.has_value(), "sphere_radius"}})
    if (given && !isMesh) section.fail(key, fmt::format("does not apply to a {}; remove it", kind));
  if (s.tipRadius && !isCone) section.fail("tip_radius", fmt::format("does not apply to a {}; remove it", kind));
  if (s.tipRadius && *s.tipRadius > *s.radius)
    section.fail("tip_radius", fmt::format("[m] is above radius, {:g} m; swap them and reverse axis", *s.radius));
  if (s.axis && norm(*s.axis) == 0) section.fail("axis", "[-] is zero; give a direction, e.g. [0, 0, 1]");
  if (s.axis && s.kind == ShapeKind::sphere) section.fail("axis", "does not apply to a sphere; remove it");
  const bool isTurned = isBox || isMesh;
  if (s.angle && !isTurned) section.fail("angle", fmt::format("does not apply to a {}; remove it", kind));
  if (isTurned && s.axis.has_value() != s.angle.has_value())
    section.fail("axis", fmt::format("and angle turn a {} together; give both or neither", kind));
}

void checkBody(const Section& section, BodySection& body, const Scene& scene) {
  checkCompany(section, scene);
  for (const Section& shape : section.list("shape")) {
    body.shapes.push_back(shape.read(shapeTable()));
    ShapeSection& read = body.shapes.back();
    checkShape(shape, read);
    if (!read.file) continue;
    resolveFile(scene, shape, "file", *read.file);
    read.loaded = loadMesh(shape, *read.file, read.scale.value_or(1), read.sphereRadius, true);
  }
  if (!body.probe && norm(body.probePosition) > 0)
    section.fail("probe_position", "[m] has no effect without probe_size; add the edges of the box, or remove it");
  for (const char* key : {"material", "density"})
    if (body.shapes.empty() && section.has(key))
      section.fail(key, "has no effect without a shape; add [[body.shape]], or remove it");
  if (body.density && body.mass) section.fail("density", "[kg/m3] and mass exclude each other; remove one");
  if (body.density && body.fixed) section.fail("density", "[kg/m3] has no effect on a fixed body; remove it");
  if (body.shapes.empty()) return;
  if (body.point)
    section.fail("point", "has no inertia, which [[body.shape]] needs; remove it, and give inertia or box");
  if (body.material.empty()) section.fail("material", "is missing, which [[body.shape]] needs; add the name of one");
  requireMaterial(scene, section, "material", body.material);
  if (!body.mass && !body.fixed && !body.density) body.density = scene.material(body.material).density;
  if (scene.run.tolerance)
    scene.fail("run", "tolerance", "controls the steps of a mechanism alone; remove it, or the shapes of the bodies");
}

/// Contact forces stay the same over a step. Symplectic Euler takes them as it takes those of grains; RATTLE would move
/// bodies by them twice, and a stiff contact would gain energy in each step.
void setIntegrator(const Section& root, Scene& scene) {
  if (scene.vehicle && !scene.mechanism.empty()) scene.run.integrator = multibody::Integrator::kSymplecticEuler;
  if (!scene.mechanism.touches()) return;
  constexpr std::size_t kMostShapes = 255; // as a grain's list of parts counts them
  std::size_t shapes = 0;
  const std::vector<Section> bodies = root.list("body");
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if ((shapes += scene.mechanism.bodies[b].shapes.size()) > kMostShapes)
      bodies[b].fail("shape", fmt::format("is beyond the {} shapes that a scene can have; use fewer", kMostShapes));
  if (root.section("run").has("integrator") && scene.run.integrator == multibody::Integrator::kRattle)
    root.section("run").fail("integrator", "adds energy to stiff contacts of bodies; choose \"symplectic_euler\", or "
                                           "remove it: with [[body.shape]] that is the default");
  scene.run.integrator = multibody::Integrator::kSymplecticEuler;
}

/// [[body]] with its [[body.shape]]s.
SectionEntry bodies() {
  const Table<BodySection> table = bodyTable().leaveOutEmpty();
  const Table<ShapeSection> shapes = shapeTable();
  SectionEntry entry;
  entry.name = "body";
  entry.read = [table](const Section& root, Scene& scene) {
    for (const Section& section : root.list("body"))
      scene.mechanism.bodies.push_back(readChecked<BodySection>(section, table, checkBody, scene, {"shape"}));
    setIntegrator(root, scene);
  };
  entry.write = [table, shapes](const Scene& scene) {
    std::string text;
    for (const BodySection& body : scene.mechanism.bodies) {
      text += written<BodySection>("[[body]]", table, body);
      for (const ShapeSection& shape : body.shapes) text += written<ShapeSection>("[[body.shape]]", shapes, shape);
    }
    return text;
  };
  entry.describe = [table, shapes] { return base::describe(table) + "\n" + base::describe(shapes); };
  entry.renameKeys = [table](base::Document& document) { document.renameKeys("body", table.formerKeys()); };
  entry.keys = fullKeys("body", table);
  for (const std::string& key : fullKeys("body.shape", shapes)) entry.keys.push_back(key);
  return entry;
}

Table<MechanismPlacement> placementTable() {
  Table<MechanismPlacement> t("mechanism", "Placement of all bodies of a mechanism together");
  t.add("above_bed", &MechanismPlacement::aboveBed, "m",
        "lifts bodies, joints and all that is held by the world together until each shape is at least this far above "
        "the highest grain under it, once the bed has settled")
      .atLeast(0)
      .atMost(1e5);
  return t;
}

void checkPlacement(const Section& section, MechanismPlacement& placement, const Scene& scene) {
  if (!placement.aboveBed) return;
  if (scene.document->root().has("vehicle"))
    section.fail("above_bed",
                 "[m] is not supported beside [vehicle], with which bodies are set down that joints tie to "
                 "it; remove it");
  if (!scene.mechanism.touches())
    section.fail("above_bed", "[m] places shapes of bodies, of which there are none; add [[body.shape]], or remove it");
  if (!scene.terrain || !scene.terrain->granular())
    section.fail("above_bed", "[m] requires a bed of grains; add a granular [terrain], or remove it and set the "
                              "positions of the bodies");
}

/// One kind of part of a mechanism. A text or list that is empty was not given, and is not written.
template <class Part>
SectionEntry part(const std::string& name, std::vector<Part> MechanismSections::*parts, base::Table<Part> table) {
  const auto where = [parts](auto& scene) -> auto& { return scene.mechanism.*parts; };
  return list<Part>(name, where, table.leaveOutEmpty());
}

} // namespace

SectionList mechanismSections() {
  using M = MechanismSections;
  return {bodies(),
          part("joint", &M::joints, jointTable()),
          part("spring", &M::springs, springTable()),
          part("bushing", &M::bushings, bushingTable()),
          part("drive", &M::drives, driveTable()),
          part("coupling", &M::couplings, couplingTable()),
          optional<MechanismPlacement>(
              "mechanism", [](auto& scene) -> auto& { return scene.mechanism.placement; }, placementTable(),
              checkPlacement)};
}

} // namespace grouser::scene::detail

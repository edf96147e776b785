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
  Table<S> t("[body]", "Rigid body of a mechanism");
  t.add("name", &S::name, "", "name that joints and springs use for the body; \"world\" is reserved for the ground")
      .required();
  t.add("mass", &S::mass, "kg",
        "mass; default: density times volume of the shapes; required if the body has no shapes and is not fixed")
      .plausible(1e-6, 2e6)
      .above(0)
      .atMost(1e12);
  t.add("density", &S::density, "kg/m3",
        "density of the shapes, instead of mass; mass and inertia are sums over the shapes, so that the common volume "
        "of overlapping shapes counts twice; default: density of the material")
      .plausible(10, 25000)
      .above(0)
      .atMost(1e6);
  t.add("inertia", &S::inertia, "kg m2",
        "moments of inertia about the centre of mass in the body axes: xx, yy, zz, optionally also the matrix entries "
        "xy, xz, yz; default: moments of the uniform box, or of the uniform shapes")
      .plausible(1e-12, 1e8);
  t.add("box", &S::box, "m",
        "edge lengths of the box that represents the body in pictures; default: from mass and inertia")
      .plausible(1e-4, 200)
      .above(0)
      .atMost(1e5);
  t.add("position", &S::position, "m", "initial position of the centre of mass")
      .plausible(0, 1000)
      .atLeast(-1e6)
      .atMost(1e6);
  t.add("axis", &S::axis, "-", "axis of the rotation from the world axes to the initial body axes; requires angle");
  t.add("angle", &S::angle, "deg", "angle of the rotation about axis, right-handed, in degrees")
      .plausible(0, 360)
      .atLeast(-3600)
      .atMost(3600);
  t.add("orientation", &S::orientation, "-",
        "initial orientation as a unit quaternion w, x, y, z (body to world), instead of axis and angle");
  t.add("velocity", &S::velocity, "m/s", "initial velocity of the centre of mass, world components").plausible(0, 300);
  t.add("spin", &S::spin, "rad/s", "initial angular velocity, world components").plausible(0, 1500);
  t.add("fixed", &S::fixed, "", "whether the body is fixed in the world");
  t.add("point", &S::point, "",
        "whether the body is a point mass, without extent or inertia; supports spherical joints, distance joints and "
        "springs only");
  t.add("material", &S::material, "", "name of the material of the shapes; required with [[body.shape]]");
  t.add("largest_overlap", &S::largestOverlap, "m",
        "largest overlap of its shapes with other bodies and with rigid surfaces; a deeper contact ends the run; "
        "default: half of the smallest half extent of each shape")
      .plausible(1e-6, 10)
      .above(0)
      .atMost(1e5);
  t.add("probe_size", &S::probe, "m",
        "edge lengths of a box in the body frame; the mass of all grains with centres inside this box is recorded as "
        "grain_mass")
      .plausible(1e-4, 100)
      .above(0)
      .atMost(1e5);
  t.add("probe_position", &S::probePosition, "m", "centre of the probe box in the body frame").plausible(0, 1000);
  return t;
}

Table<ShapeSection> shapeTable() {
  using S = ShapeSection;
  Table<S> t("[body.shape]", "Contact shape of the preceding [[body]]; a body may have several shapes");
  t.add("kind", &S::kind, "", "kind of shape: sphere, box, cylinder, capsule, cone or mesh").required();
  t.add("size", &S::size, "m", "edge lengths of a box").plausible(1e-4, 100).above(0).atMost(1e5);
  t.add("radius", &S::radius, "m", "radius of a sphere, cylinder or capsule, or of the base of a cone")
      .plausible(1e-4, 100)
      .above(0)
      .atMost(1e5);
  t.add("tip_radius", &S::tipRadius, "m", "tip radius of a truncated cone; default: 0")
      .plausible(0, 100)
      .atLeast(0)
      .atMost(1e5);
  t.add("length", &S::length, "m", "length of a cylinder, height of a cone, or length of a capsule without its caps")
      .plausible(1e-4, 100)
      .above(0)
      .atMost(1e5);
  t.add("file", &S::file, "",
        "closed mesh with outward normals (OBJ, STL, PLY...); searched for in the scene's folder, the working folder "
        "and the assets folder");
  t.add("scale", &S::scale, "m", "length of one unit of the mesh file; default: 1").above(0).atMost(1e6);
  t.add("sphere_radius", &S::sphereRadius, "m",
        fmt::format("radius of the spheres that represent a mesh in contacts; default: {} of the mesh's diagonal, or "
                    "less if spheres would protrude from the mesh by more than a fiftieth of the smallest grain radius "
                    "or of the smallest thickness of other bodies; without this key, a mesh that is exactly a box, in "
                    "any orientation, is a box without spheres",
                    MeshSection::kShareOfDiagonal))
      .plausible(1e-5, 1)
      .atLeast(spheredecomp::kSmallestRadius)
      .atMost(spheredecomp::kLargestRadius);
  t.add("position", &S::position, "m",
        "position of the centre in the body frame (cone: point at half its height; mesh: origin of the file)")
      .plausible(0, 100)
      .atLeast(-1e5)
      .atMost(1e5);
  t.add("axis", &S::axis, "-",
        "axis of a cylinder, capsule or cone (from base to tip) in the body frame, default: z; for a box or mesh the "
        "rotation axis, together with angle");
  t.add("angle", &S::angle, "deg", "rotation angle of a box or mesh about axis, right-handed, in degrees")
      .plausible(0, 360)
      .atLeast(-3600)
      .atMost(3600);
  return t;
}

Table<JointSection> jointTable() {
  using S = JointSection;
  Table<S> t(
      "[joint]",
      "Joint between two bodies; joint coordinates describe the motion of the second body relative to the first");
  t.add("name", &S::name, "", "name that springs, drives and couplings use for the joint").required();
  t.add("type", &S::type, "",
        "type of joint and its free motion: revolute (one rotation), spherical (all rotations), universal (two "
        "rotations), prismatic (a translation), cylindrical (rotation and translation), fixed (none), distance (all "
        "motions at a constant distance of two points)");
  t.add("bodies", &S::bodies, "", "names of the two bodies, e.g. [\"world\", \"rod\"]").required();
  t.add("point", &S::point, "m", "initial position of the joint in the world").plausible(0, 1000);
  t.add("axis", &S::axis, "-",
        "initial axis of rotation or translation in the world; for a universal joint, the axis of the first body");
  t.add("second_axis", &S::secondAxis, "-", "axis of the second body of a universal joint, perpendicular to axis");
  t.add("point_a", &S::pointA, "m",
        "position of the joint in the frame of the first body, instead of point; requires point_b")
      .plausible(0, 1000);
  t.add("point_b", &S::pointB, "m", "position of the joint in the frame of the second body").plausible(0, 1000);
  t.add("axis_a", &S::axisA, "-", "axis in the frame of the first body, instead of axis; requires axis_b");
  t.add("axis_b", &S::axisB, "-", "axis in the frame of the second body; for a universal joint, the second axis");
  t.add("length", &S::length, "m",
        "distance between point_a and point_b of a distance joint; default: the initial distance")
      .plausible(1e-4, 1000)
      .above(0)
      .atMost(1e5);
  t.add("damping", &S::damping, "N m s/rad or N s/m",
        "damping of the free axis; for a cylindrical joint, damping of the rotation")
      .atLeast(0);
  t.add("slide_damping", &S::slideDamping, "N s/m", "damping of the translation of a cylindrical joint").atLeast(0);
  t.add("limits", &S::limits, "rad or m",
        "positions of the lower and upper end stop on the free axis; angles in radians")
      .plausible(0, 20);
  t.add("stop_stiffness", &S::stopStiffness, "N m/rad or N/m", "stiffness of the end stops; required with limits")
      .atLeast(0);
  t.add("stop_damping", &S::stopDamping, "N m s/rad or N s/m",
        "damping of the end stops; the force of a stop never becomes tensile")
      .atLeast(0);
  return t;
}

Table<SpringSection> springTable() {
  using S = SpringSection;
  Table<S> t("[spring]", "Spring and damper between two points, or on the free axis of a joint");
  t.add("name", &S::name, "", "name in results and messages").required();
  t.add("bodies", &S::bodies, "",
        "names of the two connected bodies; to connect them along a joint axis, set joint instead");
  t.add("point_a", &S::pointA, "m", "end point on the first body, in its frame; default: (0, 0, 0)").plausible(0, 1000);
  t.add("point_b", &S::pointB, "m", "end point on the second body, in its frame; default: (0, 0, 0)")
      .plausible(0, 1000);
  t.add("joint", &S::joint, "",
        "name of a revolute, prismatic or cylindrical joint, instead of bodies; the spring acts on the free axis of "
        "the joint");
  t.add("acts_on", &S::actsOn, "", "for a cylindrical joint: the axis to act on");
  t.add("stiffness", &S::stiffness, "N/m or N m/rad", "stiffness of the spring").atLeast(0);
  t.add("damping", &S::damping, "N s/m or N m s/rad", "damping coefficient; any value is stable (implicit integration)")
      .atLeast(0);
  t.add("preload", &S::preload, "N or N m", "force at free_position; positive values push the bodies apart");
  t.add("free_position", &S::freePosition, "m or rad",
        "length of the spring, or position of the joint axis, at which the force equals preload; default: the initial "
        "value")
      .plausible(0, 100);
  t.add("limits", &S::limits, "rad or m",
        "positions of the lower and upper end stop on the axis of a joint; angles in radians")
      .plausible(0, 20);
  t.add("stop_stiffness", &S::stopStiffness, "N m/rad or N/m", "stiffness of the end stops; required with limits")
      .atLeast(0);
  t.add("stop_damping", &S::stopDamping, "N m s/rad or N s/m",
        "damping of the end stops; the force of a stop never becomes tensile")
      .atLeast(0);
  return t;
}

Table<BushingSection> bushingTable() {
  using S = BushingSection;
  Table<S> t(
      "[bushing]",
      "Elastic bushing: springs and dampers between two bodies in all six degrees of freedom, initially unloaded");
  t.add("name", &S::name, "", "name in results and messages").required();
  t.add("bodies", &S::bodies, "", "names of the two bodies").required();
  t.add("point", &S::point, "m", "initial position of the centre in the world").plausible(0, 1000).required();
  t.add("axis", &S::axis, "-", "initial direction of the bushing's z axis in the world; default: the world axes");
  t.add("stiffness", &S::stiffness, "N/m", "stiffness along the bushing's x, y, z").plausible(1, 1e11).atLeast(0);
  t.add("damping", &S::damping, "N s/m", "damping along the bushing's x, y, z").atLeast(0);
  t.add("rotation_stiffness", &S::rotationStiffness, "N m/rad", "stiffness about the bushing's x, y, z")
      .plausible(1e-2, 1e10)
      .atLeast(0);
  t.add("rotation_damping", &S::rotationDamping, "N m s/rad", "damping about the bushing's x, y, z").atLeast(0);
  return t;
}

Table<DriveSection> driveTable() {
  using S = DriveSection;
  Table<S> t("[drive]", "Motor on a free axis of a joint; imposes the sum of value, polynomial, sine and table as a "
                        "function of time; the results contain the torque or force and the power of the motor");
  t.add("name", &S::name, "", "name in results and messages").required();
  t.add("joint", &S::joint, "", "name of a revolute, prismatic or cylindrical joint").required();
  t.add("acts_on", &S::actsOn, "", "for a cylindrical joint: the axis to act on");
  t.add("imposes", &S::imposes, "",
        "prescribed quantity: speed or position of the axis, or torque on the axis (for a translation, force)");
  t.add("value", &S::value, "rad/s, rad, N m or m/s, m, N", "constant value");
  t.add("polynomial", &S::polynomial, "unit of value / s^i",
        "coefficients c0, c1, c2... of c0 + c1 t + c2 t^2..., instead of value");
  t.add("amplitude", &S::amplitude, "as value", "amplitude of the sine");
  t.add("frequency", &S::frequency, "Hz", "frequency of the sine").plausible(1e-3, 1000).atLeast(0).atMost(1e6);
  t.add("phase", &S::phase, "deg", "phase of the sine at t = 0, in degrees")
      .plausible(1, 360)
      .atLeast(-3600)
      .atMost(3600);
  t.add("time", &S::time, "s",
        "times of the table, in increasing order; a repeated time defines a jump (not allowed for position)")
      .plausible(0, 3600)
      .atLeast(0);
  t.add("values", &S::values, "as value",
        "values of the table; speed and torque are interpolated linearly, position by a smooth spline that starts and "
        "ends at rest; before and after the table, the value is constant");
  return t;
}

Table<CouplingSection> couplingTable() {
  using S = CouplingSection;
  Table<S> t("[coupling]", "Coupling of two joint axes (gears, belt, rack and pinion, screw): position of the second = "
                           "ratio x position of the first + offset");
  t.add("name", &S::name, "", "name in results and messages").required();
  t.add("joints", &S::joints, "", "names of the two joints").required();
  t.add("ratio", &S::ratio, "-, m/rad or rad/m", "motion of the second axis / motion of the first axis").required();
  t.add("offset", &S::offset, "rad or m",
        "offset in this equation; default: the value that the initial positions imply");
  t.add("acts_on", &S::actsOn, "", "axis of each joint, required for cylindrical joints, e.g. [\"angle\", \"slide\"]");
  return t;
}

/// Rejects sections that are incompatible with bodies, or with bodies without shapes.
void checkCompatibility(const Section& section, const Scene& scene) {
  const Section root = scene.document->root();
  const auto touches = [](const Section& body) { return body.has("shape"); };
  const std::vector<Section> bodies = root.list("body");
  const bool anyTouches = std::any_of(bodies.begin(), bodies.end(), touches);
  for (const char* other : {"grain", "grains", "source", "plane", "box", "cylinder", "mesh", "terrain", "fluid"})
    if (root.has(other) && !anyTouches && !root.has("vehicle"))
      section.fail("", fmt::format("is incompatible with {}, since no body has a shape for contact; add "
                                   "[[body.shape]], or use a separate scene",
                                   other));
  const bool bed = scene.terrain && scene.terrain->granular();
  if (root.has("mesh") && (bed || root.has("grain") || root.has("grains") || root.has("source")))
    section.fail("",
                 "is incompatible with [[mesh]] in scenes with grains; use boxes and cylinders, or remove the grains");
}

void checkShape(const Section& section, const ShapeSection& s) {
  const bool isBox = s.kind == ShapeKind::box, isMesh = s.kind == ShapeKind::mesh;
  const bool isCone = s.kind == ShapeKind::cone;
  const bool isLong = s.kind == ShapeKind::cylinder || s.kind == ShapeKind::capsule || isCone;
  const std::string kind(base::wordOf(s.kind));
  const auto need = [&](bool needed, bool given, const char* key, const char* example) {
    if (needed && !given)
      section.fail(key, fmt::format("{}is missing, but a {} requires it; add e.g. {}",
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
  if (s.axis && norm(*s.axis) == 0) section.fail("axis", "[-] has zero length; set a direction, e.g. [0, 0, 1]");
  if (s.axis && s.kind == ShapeKind::sphere) section.fail("axis", "does not apply to a sphere; remove it");
  const bool isTurned = isBox || isMesh;
  if (s.angle && !isTurned) section.fail("angle", fmt::format("does not apply to a {}; remove it", kind));
  if (isTurned && s.axis.has_value() != s.angle.has_value())
    section.fail("axis", fmt::format("and angle must be set together for a {}; set both or neither", kind));
}

void checkBody(const Section& section, BodySection& body, const Scene& scene) {
  checkCompatibility(section, scene);
  for (const Section& shape : section.list("shape")) {
    body.shapes.push_back(shape.read(shapeTable()));
    ShapeSection& read = body.shapes.back();
    checkShape(shape, read);
    if (!read.file) continue;
    resolveFile(scene, shape, "file", *read.file);
    read.loaded = loadMesh(shape, *read.file, read.scale.value_or(1), read.sphereRadius, true);
  }
  if (!body.probe && norm(body.probePosition) > 0)
    section.fail("probe_position", "[m] has no effect without probe_size; add probe_size, or remove it");
  for (const char* key : {"material", "density", "largest_overlap"})
    if (body.shapes.empty() && section.has(key))
      section.fail(key, "has no effect without a shape; add [[body.shape]], or remove it");
  if (body.density && body.mass) section.fail("density", "[kg/m3] is mutually exclusive with mass; remove one");
  if (body.density && body.fixed) section.fail("density", "[kg/m3] has no effect on a fixed body; remove it");
  if (body.shapes.empty()) return;
  if (body.point)
    section.fail("point", "makes the body a point mass without inertia, but [[body.shape]] requires inertia; remove "
                          "point, and set inertia or box");
  if (body.material.empty())
    section.fail("material", "is missing, but a body with [[body.shape]] requires it; set the name of a material");
  requireMaterial(scene, section, "material", body.material);
  if (!body.mass && !body.fixed && !body.density) body.density = scene.material(body.material).density;
  if (scene.run.tolerance)
    scene.fail("run", "tolerance",
               "applies to mechanisms without contacts only; remove it, or the shapes of the bodies");
}

/// Contact forces are constant over a step. Symplectic Euler applies them to bodies as to grains. RATTLE would move
/// bodies twice by the same forces, so that a stiff contact would gain energy in each step.
void setIntegrator(const Section& root, Scene& scene) {
  const auto present = [&root](const char* key) { return root.has(key); };
  const auto parts = {"body", "joint", "spring", "bushing", "drive", "coupling"}; // springs need no body of their own
  if (scene.vehicle && std::any_of(parts.begin(), parts.end(), present))
    scene.run.integrator = multibody::Integrator::kSymplecticEuler;
  if (!scene.mechanism.touches()) return;
  constexpr std::size_t kMaxShapes = 255; // 8-bit index in a grain's list of parts
  std::size_t shapes = 0;
  const std::vector<Section> bodies = root.list("body");
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if ((shapes += scene.mechanism.bodies[b].shapes.size()) > kMaxShapes)
      bodies[b].fail("shape", fmt::format("exceeds the maximum of {} shapes in a scene; use fewer", kMaxShapes));
  if (root.section("run").has("integrator") && scene.run.integrator == multibody::Integrator::kRattle)
    root.section("run").fail("integrator", "makes stiff contacts of bodies gain energy; set \"symplectic_euler\", or "
                                           "remove the key (with [[body.shape]], \"symplectic_euler\" is the default)");
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
  Table<MechanismPlacement> t("mechanism", "Common placement of all bodies of a mechanism");
  t.add("above_bed", &MechanismPlacement::aboveBed, "m",
        "minimum gap between each shape and the highest grain below it after the bed has settled; bodies, joints and "
        "attachments to the world are raised or lowered together to this gap")
      .plausible(0, 100)
      .atLeast(0)
      .atMost(1e5);
  return t;
}

void checkPlacement(const Section& section, MechanismPlacement& placement, const Scene& scene) {
  if (!placement.aboveBed) return;
  if (scene.document->root().has("vehicle"))
    section.fail(
        "above_bed",
        "[m] is incompatible with [vehicle], since towed bodies are placed together with the vehicle; remove it");
  if (!scene.mechanism.touches())
    section.fail("above_bed", "[m] has no effect without shapes of bodies; add [[body.shape]], or remove it");
  if (!scene.terrain || !scene.terrain->granular())
    section.fail("above_bed", "[m] requires a bed of grains; add a granular [terrain], or remove it and set the "
                              "positions of the bodies");
}

/// Notes a value in degrees or revolutions per minute; its unit depends on what the drive imposes.
void noteDriveValue(const Section& section, DriveSection& drive, const Scene&) {
  if (drive.imposes != multibody::DriveKind::kSpeed && drive.imposes != multibody::DriveKind::kPosition) return;
  const bool speed = drive.imposes == multibody::DriveKind::kSpeed;
  base::Field field;
  field.unit = speed ? "rad/s" : "rad or m";
  field.plausible(0, speed ? 200 : 50);
  field.type = base::FieldType::Real;
  section.noteIfUnusual("value", field, section.path() + ".value");
  field.type = base::FieldType::RealList;
  section.noteIfUnusual("values", field, section.path() + ".values");
}

/// Section of one kind of mechanism part. Empty texts and lists are not written.
template <class Part> SectionEntry part(const std::string& name, std::vector<Part> MechanismSections::*parts,
                                        base::Table<Part> table, CheckOf<Part> check = {}) {
  const auto where = [parts](auto& scene) -> auto& { return scene.mechanism.*parts; };
  return list<Part>(name, where, table.leaveOutEmpty(), check);
}

} // namespace

SectionList mechanismSections() {
  using M = MechanismSections;
  return {bodies(),
          part("joint", &M::joints, jointTable()),
          part("spring", &M::springs, springTable()),
          part("bushing", &M::bushings, bushingTable()),
          part<DriveSection>("drive", &M::drives, driveTable(), noteDriveValue),
          part("coupling", &M::couplings, couplingTable()),
          optional<MechanismPlacement>(
              "mechanism", [](auto& scene) -> auto& { return scene.mechanism.placement; }, placementTable(),
              checkPlacement)};
}

} // namespace grouser::scene::detail

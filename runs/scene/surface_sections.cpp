// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [[plane]], [[box]], [[cylinder]] and [[mesh]], the rigid surfaces that grains touch.
#include "runs/scene/detail/section_lists.hpp"

#include "base/name_fault.hpp"
#include "base/rounded.hpp"
#include "runs/scene/detail/section_checks.hpp"
#include "runs/support/orientation.hpp"
#include "runs/support/section_fault.hpp"
#include "spheredecomp/decompose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

/// Keys common to all rigid surfaces.
template <class S> void addSurface(Table<S>& t) {
  using base::Vec3d;
  using Number = std::optional<double>;
  using Vector = std::optional<Vec3d>;
  t.template add<std::string>("material", &S::material, "", "name of the material").required();
  t.template add<std::optional<std::string>>("name", &S::name, "",
                                             "name in results.h5 and timeseries.csv; default: kind and number");
  t.template add<Vector>("velocity", &S::velocity, "m/s", "prescribed velocity")
      .plausible(0, 100)
      .atLeast(-1e4)
      .atMost(1e4);
  t.template add<Vector>("spin", &S::spin, "rad/s", "prescribed angular velocity, world components")
      .plausible(0, 200)
      .atLeast(-1e5)
      .atMost(1e5);
  t.template add<Vector>("pivot", &S::pivot, "m",
                         "centre of rotation, which moves with velocity; default: centre of the surface")
      .plausible(0, 1000);
  t.template add<Vector>("amplitude", &S::amplitude, "m", "amplitude vector of a sinusoidal oscillation")
      .plausible(0, 5);
  t.template add<Number>("frequency", &S::frequency, "Hz", "frequency of the oscillation")
      .plausible(1e-3, 1e4)
      .above(0)
      .atMost(1e5);
  t.template add<Number>("phase", &S::phase, "deg",
                         "phase of the sine at the start, in degrees; with -90, the surface starts at rest")
      .plausible(1, 360)
      .atLeast(-360)
      .atMost(360);
  t.template add<Number>("start", &S::start, "s", "start time of velocity, spin and oscillation")
      .plausible(0, 1000)
      .atLeast(0)
      .atMost(1e5);
  t.template add<Number>("until", &S::until, "s", "end time of velocity, spin and oscillation")
      .plausible(0, 3600)
      .above(0)
      .atMost(1e5);
  t.template add<std::optional<Axis>>(
      "free", &S::free, "",
      "axis along which the surface moves freely under load, grain forces and weight from the start of the run, in "
      "addition to velocity, spin and amplitude (e.g. a wheel under load, or a plate that is pulled or turned)");
  t.template add<Number>("mass", &S::mass, "kg", "mass of a free surface; required with free")
      .plausible(1e-6, 1e6)
      .above(0)
      .atMost(1e12);
  t.template add<Number>("load", &S::load, "N",
                         "force on a free surface along the free axis; along z, negative values press down")
      .plausible(0, 1e7)
      .atLeast(-1e12)
      .atMost(1e12);
  t.template add<Number>("load_ramp", &S::loadRamp, "s", "duration of the load's ramp from 0; default: 0")
      .plausible(0, 100)
      .atLeast(0)
      .atMost(1e5);
  t.template add<std::optional<PlacedWhen>>(
      "placed", &S::placed, "",
      "time of placement in scenes with a bed that settles: before (the bed settles around the surface) or "
      "after_settling (on the settled bed); default: before for fixed surfaces, after_settling for meshes and moving "
      "surfaces");
  t.template add<Number>("above_bed", &S::aboveBed, "m",
                         "gap between the surface and the highest grain below it after the bed has settled; replaces "
                         "the z coordinate of position or point")
      .plausible(0, 100)
      .atLeast(0)
      .atMost(1e4);
}

/// Initial orientation of a surface; `from`: the reference axes.
template <class S> void addTurn(Table<S>& t, const std::string& from) {
  t.add("axis", &S::axis, "-",
        "axis of the rotation to the initial orientation, relative to the " + from + " axes; requires angle");
  t.add("angle", &S::angle, "deg", "angle of the rotation about axis, right-handed, in degrees")
      .plausible(0, 360)
      .atLeast(-3600)
      .atMost(3600);
  t.add("orientation", &S::orientation, "-",
        "initial orientation as a unit quaternion w, x, y, z, instead of axis and angle");
}

Table<Plane> planeTable() {
  using S = Plane;
  Table<S> t("[plane]", "Rigid plane, fixed or moving; the normal points out of the solid");
  t.add("point", &S::point, "m", "a point of the plane; reference point of loads").plausible(0, 1000);
  t.add("normal", &S::normal, "-", "outward normal of the solid; any non-zero length");
  addSurface(t);
  return t;
}

Table<BoxSection> boxTable() {
  using S = BoxSection;
  Table<S> t("[box]", "Rigid solid box, fixed or moving");
  t.add("position", &S::position, "m", "position of the centre").plausible(0, 1000).required();
  t.add("size", &S::size, "m", "edge lengths along x, y, z before rotation")
      .plausible(1e-4, 100)
      .above(0)
      .atMost(1e5)
      .required();
  addTurn(t, "world's");
  addSurface(t);
  return t;
}

Table<CylinderSection> cylinderTable() {
  using S = CylinderSection;
  Table<S> t("[cylinder]", "Rigid cylinder, fixed or moving; solid with flat ends, or hollow");
  t.add("position", &S::position, "m", "position of the centre").plausible(0, 1000).required();
  t.add("axis", &S::axis, "-", "direction of the axis; any non-zero length");
  t.add("radius", &S::radius, "m", "radius").plausible(1e-4, 100).above(0).atMost(1e5).required();
  t.add("length", &S::length, "m", "length along the axis").plausible(1e-4, 100).above(0).atMost(1e5).required();
  t.add("hollow", &S::hollow, "",
        "whether the cylinder is a drum or pipe of zero thickness, open at both ends, with contact inside and outside");
  addSurface(t);
  return t;
}

Table<MeshSection> meshTable() {
  using S = MeshSection;
  Table<S> t("[mesh]", "Rigid mesh, fixed or moving; spheres represent it in contacts with grains");
  t.add("file", &S::file, "",
        "closed mesh with outward normals (OBJ, STL, PLY...); searched for in the scene's folder, the working folder "
        "and the assets folder")
      .required();
  t.add("scale", &S::scale, "m", "length of one unit of the file").above(0).atMost(1e6);
  t.add("position", &S::position, "m", "position of the file's origin, the reference point of loads")
      .plausible(0, 1000);
  addTurn(t, "file's");
  t.add("sphere_radius", &S::sphereRadius, "m",
        fmt::format("radius of the spheres that represent the mesh (they round the edges of the mesh); default: {} of "
                    "the diagonal, or less if spheres would protrude by more than a fiftieth of the smallest grain "
                    "radius, or of a quarter of the track pitch of a vehicle",
                    S::kShareOfDiagonal))
      .plausible(1e-5, 1)
      .atLeast(spheredecomp::kSmallestRadius)
      .atMost(spheredecomp::kLargestRadius);
  t.add("sphere_refinement", &S::sphereRefinement, "-",
        "divisor of the sphere radius, and of the permitted protrusion if the radius is automatic; grouser check "
        "doubles this divisor in its finer case")
      .atLeast(1)
      .atMost(16);
  addSurface(t);
  return t;
}

void checkOscillation(const Section& section, const SurfaceSection& s) {
  if (s.amplitude && !s.frequency) section.fail("frequency", "[Hz] is missing, but amplitude requires it; add it");
  for (const char* key : {"frequency", "phase"})
    if (!s.amplitude && section.has(key))
      section.fail(key, "has no effect without amplitude; add amplitude, or remove it");
}

void checkFree(const Section& section, const SurfaceSection& s) {
  if (!s.free) {
    for (const char* key : {"mass", "load", "load_ramp"})
      if (section.has(key))
        section.fail(key, "applies to free surfaces only; add free = \"z\" (or x, y), or remove it");
    return;
  }
  if (!s.mass) section.fail("mass", "[kg] is missing, but a free surface requires it; add it");
  if (s.loadRamp && !s.load) section.fail("load_ramp", "[s] has no effect without load; add load, or remove it");
  const int axis = static_cast<int>(*s.free);
  const auto prescribed = [&](const char* key, const std::optional<base::Vec3d>& v) {
    if (v && (*v)[axis] != 0)
      section.fail(key, fmt::format("prescribes motion along {}, the free axis; set this entry to 0, or remove free",
                                    base::wordOf(*s.free)));
  };
  prescribed("velocity", s.velocity), prescribed("amplitude", s.amplitude);
}

/// Returns true if an earlier surface has that name.
bool isTaken(const std::string& name, const Scene& scene) {
  const auto among = [&](const auto& surfaces) {
    return std::any_of(surfaces.begin(), surfaces.end(), [&](const SurfaceSection& s) { return s.name == name; });
  };
  return among(scene.planes) || among(scene.boxes) || among(scene.cylinders) || among(scene.meshes);
}

/// Checks common to all surfaces.
void checkSurface(const Section& section, const SurfaceSection& s, const Scene& scene) {
  checkOscillation(section, s);
  checkFree(section, s);
  if (s.pivot && !s.spin) section.fail("pivot", "[m] has no effect without spin; add spin, or remove it");
  const bool driven = s.velocity || s.spin || s.amplitude;
  for (const char* key : {"start", "until"})
    if (section.has(key) && !driven)
      section.fail(key, "[s] has no effect on a fixed surface; add velocity, spin or amplitude");
  if (s.until && *s.until <= s.start.value_or(0)) section.fail("until", "[s] is not after start; raise it");
  if (!s.name) return;
  if (const std::string fault = base::nameFault(*s.name); !fault.empty()) section.fail("name", fault);
  if (s.name->find_first_of(". ,\"") != std::string::npos)
    section.fail(
        "name",
        "must not contain blanks, dots, commas or quotes, since it is part of column names; choose another name");
  if (isTaken(*s.name, scene)) section.fail("name", "is the name of another surface; choose another name");
}

template <class S> void checkOrientation(const Section& section, const S& s) {
  try {
    support::orientationOf(s.axis, s.angle, s.orientation.value_or(std::vector<double>{}));
  } catch (const support::SectionFault& fault) {
    section.fail(fault.key(), fault.what());
  }
}

void checkPlane(const Section& section, Plane& plane, const Scene& scene) {
  checkSurface(section, plane, scene);
  if (base::norm2(plane.normal) == 0)
    section.fail("normal", "has zero length; set the direction out of the solid, e.g. [0, 0, 1]");
  requireMaterial(scene, section, "material", plane.material);
}

void checkBox(const Section& section, BoxSection& box, const Scene& scene) {
  checkSurface(section, box, scene);
  checkOrientation(section, box);
  requireMaterial(scene, section, "material", box.material);
}

void checkCylinder(const Section& section, CylinderSection& cylinder, const Scene& scene) {
  checkSurface(section, cylinder, scene);
  if (base::norm2(cylinder.axis) == 0)
    section.fail("axis", "[-] has zero length; set the direction of the cylinder, e.g. [0, 0, 1]");
  requireMaterial(scene, section, "material", cylinder.material);
}

void checkMesh(const Section& section, MeshSection& mesh, const Scene& scene) {
  checkSurface(section, mesh, scene);
  checkOrientation(section, mesh);
  requireMaterial(scene, section, "material", mesh.material);
  resolveFile(scene, section, "file", mesh.file);
  mesh.loaded = loadMesh(section, mesh.file, mesh.scale, mesh.sphereRadius, false);
}

} // namespace

SectionList surfaceSections() {
  return {list("plane", &Scene::planes, planeTable(), checkPlane), list("box", &Scene::boxes, boxTable(), checkBox),
          list("cylinder", &Scene::cylinders, cylinderTable(), checkCylinder),
          list("mesh", &Scene::meshes, meshTable(), checkMesh)};
}

} // namespace grouser::scene::detail

// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [[plane]], [[box]], [[cylinder]] and [[mesh]], the rigid surfaces that grains touch.
#include "runs/scene/detail/section_lists.hpp"

#include "base/rounded.hpp"
#include "runs/scene/detail/section_checks.hpp"
#include "runs/support/orientation.hpp"
#include "runs/support/result_names.hpp"
#include "runs/support/section_fault.hpp"
#include "spheredecomp/decompose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

/// What all rigid surfaces have alike.
template <class S> void addSurface(Table<S>& t) {
  using base::Vec3d;
  using Number = std::optional<double>;
  using Vector = std::optional<Vec3d>;
  t.template add<std::string>("material", &S::material, "", "name of its material").required();
  t.template add<std::optional<std::string>>("name", &S::name, "",
                                             "in results.h5 and timeseries.csv; kind and number where not given");
  t.template add<Vector>("velocity", &S::velocity, "m/s", "at which it is moved").atLeast(-1e4).atMost(1e4);
  t.template add<Vector>("spin", &S::spin, "rad/s", "angular velocity at which it is turned, in the world")
      .atLeast(-1e5)
      .atMost(1e5);
  t.template add<Vector>("pivot", &S::pivot, "m",
                         "that it is turned about, which velocity moves along; its own centre where not given");
  t.template add<Vector>("amplitude", &S::amplitude, "m", "of an oscillation, along this vector");
  t.template add<Number>("frequency", &S::frequency, "Hz", "of that oscillation").above(0).atMost(1e5);
  t.template add<Number>("phase", &S::phase, "deg", "of that sine at the start; -90 begins from rest")
      .atLeast(-360)
      .atMost(360);
  t.template add<Number>("start", &S::start, "s", "when velocity, spin and oscillation begin").atLeast(0).atMost(1e5);
  t.template add<Number>("until", &S::until, "s", "when they end").above(0).atMost(1e5);
  t.template add<std::optional<Axis>>(
      "free", &S::free, "",
      "axis along which load, grains and weight move it, from the start; what velocity, spin and "
      "amplitude say moves it besides: a wheel under load, a plate pulled or turned");
  t.template add<Number>("mass", &S::mass, "kg", "of a free surface; required there").above(0).atMost(1e12);
  t.template add<Number>("load", &S::load, "N", "on a free surface along its axis; negative presses down where z is up")
      .atLeast(-1e12)
      .atMost(1e12);
  t.template add<Number>("load_ramp", &S::loadRamp, "s", "over which the load comes on; at once where not given")
      .atLeast(0)
      .atMost(1e5);
  t.template add<std::optional<PlacedWhen>>(
      "placed", &S::placed, "",
      "beside a bed that settles: before, and the bed is laid around it, or after_settling, on a bed that has settled "
      "without it; where not given, surfaces at rest before, meshes and what moves after");
  t.template add<Number>("above_bed", &S::aboveBed, "m",
                         "height of its lowest point over the highest grain under it once the bed has settled; instead "
                         "of the z that the section gives")
      .atLeast(0)
      .atMost(1e4);
}

/// How a surface that has axes of its own stands at the start; `from`: whose axes it is turned from.
template <class S> void addTurn(Table<S>& t, const std::string& from) {
  t.add("axis", &S::axis, "-", "about which it is turned from the " + from + " axes, with angle");
  t.add("angle", &S::angle, "deg", "of that turn, right-handed").atLeast(-3600).atMost(3600);
  t.add("orientation", &S::orientation, "-", "unit quaternion w, x, y, z, instead of axis and angle");
}

Table<Plane> planeTable() {
  using S = Plane;
  Table<S> t("[plane]", "A rigid plane; the solid lies behind its normal. Fixed, or moved as boxes are");
  t.add("point", &S::point, "m", "any point of the plane; loads are taken about it");
  t.add("normal", &S::normal, "-", "out of the solid; of any length but zero");
  addSurface(t);
  return t;
}

Table<BoxSection> boxTable() {
  using S = BoxSection;
  Table<S> t("[box]", "A solid rigid box that grains touch, fixed or moved");
  t.add("position", &S::position, "m", "of its centre").required();
  t.add("size", &S::size, "m", "its edges along x, y, z before it is turned").above(0).atMost(1e5).required();
  addTurn(t, "world's");
  addSurface(t);
  return t;
}

Table<CylinderSection> cylinderTable() {
  using S = CylinderSection;
  Table<S> t("[cylinder]", "A rigid cylinder that grains touch, fixed or moved: a solid rod with flat ends, or hollow");
  t.add("position", &S::position, "m", "of its centre").required();
  t.add("axis", &S::axis, "-", "its direction; of any length but zero");
  t.add("radius", &S::radius, "m", "of its wall").above(0).atMost(1e5).required();
  t.add("length", &S::length, "m", "along its axis").above(0).atMost(1e5).required();
  t.add("hollow", &S::hollow, "", "a drum or pipe without thickness, felt from inside and outside, open at both ends");
  addSurface(t);
  return t;
}

Table<MeshSection> meshTable() {
  using S = MeshSection;
  Table<S> t("[mesh]", "A rigid body from a file that grains touch, fixed or moved, cut into spheres");
  t.add("file", &S::file, "",
        "OBJ, STL, PLY...: closed, outward; looked for in the scene's folder, the working folder, the assets folder")
      .required();
  t.add("scale", &S::scale, "m", "of one unit of the file").above(0).atMost(1e6);
  t.add("position", &S::position, "m", "of the file's origin, about which loads are taken");
  addTurn(t, "file's");
  t.add("sphere_radius", &S::sphereRadius, "m",
        fmt::format(
            "of the spheres it is cut into, which round its edges; where not given {} of its diagonal, or finer where "
            "these would stand out of it by more than a fiftieth of the smallest grain's radius, or of a quarter "
            "of a vehicle's pitch",
            S::kShareOfDiagonal))
      .atLeast(spheredecomp::kSmallestRadius)
      .atMost(spheredecomp::kLargestRadius);
  t.add("sphere_refinement", &S::sphereRefinement, "-",
        "divides the sphere radius, and of an automatic one the permitted protrusion too; grouser check doubles it for "
        "its finer case")
      .atLeast(1)
      .atMost(16);
  addSurface(t);
  return t;
}

void checkOscillation(const Section& section, const SurfaceSection& s) {
  if (s.amplitude && !s.frequency) section.fail("frequency", "[Hz] is missing beside amplitude; add it");
  for (const char* key : {"frequency", "phase"})
    if (!s.amplitude && section.has(key)) section.fail(key, "has no meaning without amplitude; add that, or remove it");
}

void checkFree(const Section& section, const SurfaceSection& s) {
  if (!s.free) {
    for (const char* key : {"mass", "load", "load_ramp"})
      if (section.has(key))
        section.fail(key, "belongs to a surface that forces move; add free = \"z\" (or x, y), or remove it");
    return;
  }
  if (!s.mass) section.fail("mass", "[kg] is missing, which a free surface needs; add it");
  if (s.loadRamp && !s.load) section.fail("load_ramp", "[s] has no meaning without load; add that, or remove it");
  const int axis = static_cast<int>(*s.free);
  const auto prescribed = [&](const char* key, const std::optional<base::Vec3d>& v) {
    if (v && (*v)[axis] != 0)
      section.fail(key, fmt::format("moves the surface along {}, where free leaves it to the forces; set that entry to "
                                    "0, or remove free",
                                    base::wordOf(*s.free)));
  };
  prescribed("velocity", s.velocity), prescribed("amplitude", s.amplitude);
}

/// Whether a surface that has been read bears that name.
bool isTaken(const std::string& name, const Scene& scene) {
  const auto among = [&](const auto& surfaces) {
    return std::any_of(surfaces.begin(), surfaces.end(), [&](const SurfaceSection& s) { return s.name == name; });
  };
  return among(scene.planes) || among(scene.boxes) || among(scene.cylinders) || among(scene.meshes);
}

/// What all surfaces have alike.
void checkSurface(const Section& section, const SurfaceSection& s, const Scene& scene) {
  checkOscillation(section, s);
  checkFree(section, s);
  if (s.pivot && !s.spin) section.fail("pivot", "[m] has no meaning without spin; add that, or remove it");
  const bool driven = s.velocity || s.spin || s.amplitude;
  for (const char* key : {"start", "until"})
    if (section.has(key) && !driven)
      section.fail(key, "[s] has no meaning for a surface that is not moved; add velocity, spin or amplitude");
  if (s.until && *s.until <= s.start.value_or(0)) section.fail("until", "[s] is not after start; raise it");
  if (!s.name) return;
  if (const std::string fault = support::nameFault(*s.name); !fault.empty()) section.fail("name", fault);
  if (s.name->find_first_of(". ,\"") != std::string::npos)
    section.fail("name", "must be a word without blanks, dots, commas and quotes, since it names columns of the "
                         "results; choose another");
  if (isTaken(*s.name, scene)) section.fail("name", "is that of another surface; choose another");
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
    section.fail("normal", "is zero; give the direction out of the solid, e.g. [0, 0, 1]");
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
    section.fail("axis", "[-] is zero; give the direction of the cylinder, e.g. [0, 0, 1]");
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

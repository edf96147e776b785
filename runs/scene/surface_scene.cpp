// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/surface_scene.hpp"

#include "runs/scene/detail/scene_tables.hpp"
#include "runs/support/orientation.hpp"
#include "runs/support/result_names.hpp"
#include "runs/support/section_fault.hpp"
#include "spheredecomp/decompose.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::scene {

using base::Section;

namespace {

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
  for (int a = 0; s.spin && a < 3; ++a)
    if (a != axis && (*s.spin)[a] != 0)
      section.fail("spin", fmt::format("turns the surface about another axis than {}, along which it is free; give "
                                       "that one, or remove free",
                                       base::wordOf(*s.free)));
}

/// What all surfaces have alike. `names`: those that are taken.
void checkSurface(const Section& section, const SurfaceSection& s, std::vector<std::string>& names) {
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
  if (std::find(names.begin(), names.end(), *s.name) != names.end())
    section.fail("name", "is that of another surface; choose another");
  names.push_back(*s.name);
}

template <class S> void checkOrientation(const Section& section, const S& s) {
  try {
    support::orientationOf(s.axis, s.angle, s.orientation.value_or(std::vector<double>{}));
  } catch (const support::SectionFault& fault) {
    section.fail(fault.key(), fault.what());
  }
}

} // namespace

void readSurfaces(const Section& root, Scene& scene) {
  std::vector<std::string> names;
  for (const Section& section : root.list("plane")) {
    scene.planes.push_back(section.read(detail::planeTable()));
    checkSurface(section, scene.planes.back(), names);
    if (base::norm2(scene.planes.back().normal) == 0)
      section.fail("normal", "is zero; give the direction out of the solid, e.g. [0, 0, 1]");
  }
  for (const Section& section : root.list("box")) {
    scene.boxes.push_back(section.read(detail::boxTable()));
    checkSurface(section, scene.boxes.back(), names);
    checkOrientation(section, scene.boxes.back());
  }
  for (const Section& section : root.list("cylinder")) {
    scene.cylinders.push_back(section.read(detail::cylinderTable()));
    checkSurface(section, scene.cylinders.back(), names);
    if (base::norm2(scene.cylinders.back().axis) == 0)
      section.fail("axis", "[-] is zero; give the direction of the cylinder, e.g. [0, 0, 1]");
  }
  for (const Section& section : root.list("mesh")) {
    scene.meshes.push_back(section.read(detail::meshTable()));
    checkSurface(section, scene.meshes.back(), names);
    checkOrientation(section, scene.meshes.back());
  }
}

void loadMesh(const Section& section, MeshSection& mesh) {
  base::TriangleMesh triangles;
  try {
    triangles = spheredecomp::importMesh(mesh.file);
  } catch (const base::InputError& error) {
    section.fail("file", fmt::format("is of no use: {}", error.what()));
  }
  for (base::Vec3d& v : triangles.vertices) v *= mesh.scale;
  const auto [low, high] = spheredecomp::bounds(triangles);
  const base::Vec3d size = high - low;
  const double longest = std::max({size.x, size.y, size.z}), byDefault = norm(size) / MeshSection::kRadiiInDiagonal;
  if (!mesh.sphereRadius && !(byDefault >= spheredecomp::kSmallestRadius && byDefault <= spheredecomp::kLargestRadius))
    section.fail("scale",
                 fmt::format("[m] makes the mesh {:.4g} m long, and its spheres {:.3g} m, outside [{:g}, {:g}];"
                             " correct it: it is the length of one unit of the file",
                             longest, byDefault, spheredecomp::kSmallestRadius, spheredecomp::kLargestRadius));
  if (!mesh.sphereRadius) mesh.sphereRadius = byDefault;
  if (*mesh.sphereRadius > 0.5 * longest)
    section.fail(
        "sphere_radius",
        fmt::format("[m] is above half of the mesh's longest side of {:.4g} m; lower it, or correct scale", longest));
  if (const double points = spheredecomp::latticePoints(triangles, *mesh.sphereRadius);
      !(points <= spheredecomp::kMostLatticePoints))
    section.fail("sphere_radius",
                 fmt::format("[m] cuts the mesh of {:.4g} x {:.4g} x {:.4g} m by {:.2g} lattice points, "
                             "more than {:.0e}; raise it, or correct scale",
                             size.x, size.y, size.z, points, spheredecomp::kMostLatticePoints));
  mesh.loaded.query = std::make_shared<const spheredecomp::MeshQuery>(std::move(triangles));
}

namespace {

void checkMeshes(const Section& root, const Scene& scene) {
  const std::vector<Section> sections = root.list("mesh");
  for (std::size_t k = 0; k < sections.size(); ++k) {
    if (scene.vehicle)
      sections[k].fail("", "stands beside [vehicle]; a scene has the one or the other: use boxes and cylinders");
    if (scene.terrain && scene.terrain->granular() && scene.terrain->settleTimeLimit > 0)
      sections[k].fail("", "stands in a bed that settles first, which meshes have no part in; use boxes and cylinders, "
                           "or set terrain.settle_time_limit = 0");
    if (scene.meshes[k].material != scene.meshes.front().material)
      sections[k].fail("material", fmt::format("differs from that of the first mesh, \"{}\"; all meshes have one",
                                               scene.meshes.front().material));
  }
}

} // namespace

void checkSurfaces(const Section& root, const Scene& scene) { checkMeshes(root, scene); }

std::string surfacesToml(const Scene& scene) {
  std::string text;
  for (const Plane& p : scene.planes) text += "\n[[plane]]\n" + detail::planeTable().write(p);
  for (const BoxSection& b : scene.boxes) text += "\n[[box]]\n" + detail::boxTable().write(b);
  for (const CylinderSection& c : scene.cylinders) text += "\n[[cylinder]]\n" + detail::cylinderTable().write(c);
  for (const MeshSection& m : scene.meshes) text += "\n[[mesh]]\n" + detail::meshTable().write(m);
  return text;
}

} // namespace grouser::scene

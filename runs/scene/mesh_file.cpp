// SPDX-License-Identifier: BSD-3-Clause
// Meshes of [[mesh]] and [[body.shape]].
#include "base/error.hpp"
#include "base/rounded.hpp"
#include "runs/scene/detail/section_checks.hpp"
#include "spheredecomp/decompose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <utility>

namespace grouser::scene::detail {

namespace {

/// The number with the fewest digits that has this value in single precision, as in the file. The importer rounds all
/// coordinates to single precision.
double shortestDecimal(double value) {
  const std::string digits = fmt::format("{}", static_cast<float>(value));
  double decimal = value;
  std::from_chars(digits.data(), digits.data() + digits.size(), decimal);
  return decimal;
}

void noteUnusualSize(const base::Section& section, const base::Vec3d& size, double scale) {
  constexpr double kLongest = 50, kShortest = 1e-3; // [m] usual meshes
  const double longest = std::max({size.x, size.y, size.z});
  if (longest > kLongest || longest < kShortest)
    section.note("file", fmt::format("is a mesh of {:.4g} x {:.4g} x {:.4g} m with scale = {:g}; {}", size.x, size.y,
                                     size.z, scale,
                                     longest > kLongest ? fmt::format("in millimetres? set scale = {:g}", 1e-3 * scale)
                                                        : "check scale, the length of one unit of the file [m]"));
}

/// The box of a mesh that is exactly a box, in metres.
std::optional<spheredecomp::MeshBox> boxOf(const base::TriangleMesh& triangles, double scale) {
  std::optional<spheredecomp::MeshBox> box = spheredecomp::exactBox(triangles);
  if (!box) return box;
  base::TriangleMesh written = triangles;
  for (base::Vec3d& v : written.vertices)
    for (int k = 0; k < 3; ++k) v[k] = shortestDecimal(v[k]);
  if (const auto ofFile = spheredecomp::exactBox(written)) box = ofFile;
  box->centre *= scale, box->half *= scale;
  return box;
}

} // namespace

LoadedMesh loadMesh(const base::Section& section, const std::string& file, double scale,
                    const std::optional<double>& sphereRadius, bool centred) {
  LoadedMesh loaded;
  base::TriangleMesh triangles;
  try {
    triangles = spheredecomp::importMesh(file, &loaded.note);
  } catch (const base::InputError& error) {
    section.fail("file", fmt::format("cannot be used: {}", error.what()));
  }
  const std::optional<spheredecomp::MeshBox> box = centred ? boxOf(triangles, scale) : std::nullopt;
  const auto note = [&](const std::string& text) {
    loaded.note += fmt::format("{}{}: the mesh is {}", loaded.note.empty() ? "" : "; ", file, text);
  };
  if (box && sphereRadius) note("a box; remove sphere_radius to replace its spheres by the exact and faster box");
  if (box && !sphereRadius) {
    const base::Vec3d edges = box->half * 2.0;
    noteUnusualSize(section, edges, scale);
    loaded.box = box, loaded.middle = box->centre;
    note(fmt::format("a box of {:.5g} x {:.5g} x {:.5g} m; contacts use the exact box instead of spheres", edges.x,
                     edges.y, edges.z));
    return loaded;
  }
  for (base::Vec3d& v : triangles.vertices) v *= scale;
  const auto [low, high] = spheredecomp::bounds(triangles);
  const base::Vec3d size = high - low;
  const double longest = std::max({size.x, size.y, size.z}), byDefault = norm(size) / MeshSection::kRadiiInDiagonal;
  if (!sphereRadius && !(byDefault >= spheredecomp::kSmallestRadius && byDefault <= spheredecomp::kLargestRadius))
    section.fail("scale", fmt::format("[m] results in a mesh of length {:.4g} m with a sphere radius of {:.3g} m, "
                                      "outside [{:g}, {:g}] m; correct it (length of one unit of the file)",
                                      longest, byDefault, spheredecomp::kSmallestRadius, spheredecomp::kLargestRadius));
  noteUnusualSize(section, size, scale);
  loaded.sphereRadius = sphereRadius.value_or(byDefault);
  if (loaded.sphereRadius > 0.5 * longest)
    section.fail("sphere_radius",
                 fmt::format("[m] is above {} m, half of the mesh's longest side; lower it, or correct scale",
                             base::roundedDown(0.5 * longest, 4)));
  if (const double points = spheredecomp::latticePoints(triangles, loaded.sphereRadius);
      !(points <= spheredecomp::kMaxLatticePoints))
    section.fail("sphere_radius", fmt::format("[m] for a mesh of {:.4g} x {:.4g} x {:.4g} m requires {:.2g} lattice "
                                              "points, more than {:.0e}; raise it, or correct scale",
                                              size.x, size.y, size.z, points, spheredecomp::kMaxLatticePoints));
  if (centred) {
    loaded.middle = (low + high) * 0.5;
    for (base::Vec3d& v : triangles.vertices) v -= loaded.middle;
  }
  loaded.query = std::make_shared<const spheredecomp::MeshQuery>(std::move(triangles));
  return loaded;
}

} // namespace grouser::scene::detail

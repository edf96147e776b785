// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/parts.hpp"

#include "assets/generator/solids.hpp"

#include <cmath>
#include <cstdio>

namespace grouser::assets {

TriangleMesh chassis() {
  TriangleMesh mesh;
  // Lower hull between the tracks, 15 mm beside the shoes' bosses, with a sloped nose and a raised tail.
  prism(mesh, {{-0.05, -0.20}, {2.35, -0.20}, {2.95, 0.12}, {2.85, 0.30}, {2.60, 0.40}, {-0.25, 0.40}, {-0.25, 0.00}},
        -0.76, 0.76);
  // Upper hull over the tracks: 6 cm above the tips of the grousers on the top run.
  prism(mesh, {{-0.25, 0.36}, {2.70, 0.36}, {2.20, 0.75}, {-0.15, 0.75}}, -1.25, 1.25);
  return mesh;
}

std::vector<NamedMesh> vehicleParts() {
  return {{"shoe", shoe()},
          {"road_wheel", wheel({0.190, 0.100, 128})},
          {"roller", wheel({0.090, 0.025, 128})},
          {"idler", wheel({0.217, 0.127, 128})},
          {"sprocket", sprocket()},
          {"chassis", chassis()}};
}

std::vector<NamedMesh> rigParts() { return {{"grouser_wheel", grouserWheel()}}; }

std::string toObj(const NamedMesh& part) {
  std::string text =
      "# " + part.name + ", made by grouser_assets [m]; x forward, y left, z up\n" + "o " + part.name + "\n";
  char line[128];
  // Rounded to a picometre, so that sin(pi) prints as 0.
  auto clean = [](double v) { return std::floor(v * 1e12 + 0.5) * 1e-12 + 0.0; };
  for (const Vec3d& v : part.mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", clean(v.x), clean(v.y), clean(v.z));
    text += line;
  }
  for (std::size_t i = 0; i + 2 < part.mesh.indices.size(); i += 3) {
    const auto* t = &part.mesh.indices[i];
    std::snprintf(line, sizeof line, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  return text;
}

} // namespace grouser::assets

// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator/parts.hpp"

#include "assets/generator/solids.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

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

namespace {

/// Lower hull between the tracks, a sloped bow, and sponsons over the tracks.
TriangleMesh m113Hull() {
  TriangleMesh mesh;
  prism(mesh, {{-4.25, -0.11}, {-0.20, -0.11}, {0.45, 0.20}, {0.35, 0.42}, {-4.30, 0.42}, {-4.30, 0.00}}, -0.83, 0.83);
  prism(mesh, {{-4.35, 0.40}, {0.40, 0.40}, {-0.60, 1.28}, {-4.30, 1.28}}, -1.27, 1.27);
  return mesh;
}

/// A flat box between the tracks, with a deck over them.
TriangleMesh robotHull() {
  TriangleMesh mesh;
  prism(mesh, {{-0.02, -0.070}, {0.82, -0.070}, {1.00, 0.040}, {0.96, 0.125}, {-0.07, 0.125}, {-0.07, 0.00}}, -0.262,
        0.262);
  prism(mesh, {{-0.07, 0.120}, {0.93, 0.120}, {0.88, 0.200}, {-0.05, 0.200}}, -0.40, 0.40);
  return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3d& v : mesh.vertices) v = v * factor;
  return mesh;
}

} // namespace

std::vector<NamedMesh> m113Parts() {
  TrackDims track;
  track.padHalfWidth = 0.190, track.plateOuter = 0.150, track.bossInner = 0.195, track.bossOuter = 0.225;
  SprocketDims teeth;
  teeth.ringInner = 0.200, teeth.ringOuter = 0.220;
  return {{"m113/shoe", shoe(track)},
          {"m113/road_wheel", wheel({0.305, 0.180, 128}, track)},
          {"m113/idler", wheel({0.255, 0.150, 128}, track)},
          {"m113/sprocket", sprocket(teeth)},
          {"m113/chassis", m113Hull()}};
}

std::vector<NamedMesh> robotParts() {
  std::vector<NamedMesh> parts = vehicleParts();
  for (NamedMesh& part : parts) {
    part.mesh = part.name == "chassis" ? robotHull() : scaled(std::move(part.mesh), kRobotScale);
    part.name = "robot/" + part.name;
  }
  return parts;
}

std::vector<NamedMesh> rigParts() { return {{"grouser_wheel", grouserWheel()}}; }

std::string toObj(const NamedMesh& part) {
  std::string text =
      "# " + part.name + ", made by grouser_assets [m]; x forward, y left, z up\n" + "o " + part.name + "\n";
  char line[128];
  // Round to a picometre, so that sin(pi) prints as 0.
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

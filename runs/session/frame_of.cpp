// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/frame_of.hpp"

#include "fluid/fluid.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace grouser::session {

namespace {

/// Positions of the subdomain borders on the axes [m].
std::array<std::vector<double>, 3> bordersOf(const terrain::Grains& grains) {
  std::array<std::vector<double>, 3> borders;
  if (const terrain::GrainDistribution* ranks = grains.system().distribution.get())
    for (int axis = 0; axis < 3; ++axis)
      for (const std::int64_t cut : ranks->subdomain().partition().cuts(axis))
        borders[static_cast<std::size_t>(axis)].push_back(static_cast<double>(cut) * grains.scale().unit);
  return borders;
}

} // namespace

base::TriangleMesh groundMesh(const terrain::HeightField& field) {
  constexpr int kNodes = 160;
  base::TriangleMesh mesh;
  const terrain::Rectangle& a = field.area();
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      const double x = a.xMin + a.width() * i / (kNodes - 1), y = a.yMin + a.length() * j / (kNodes - 1);
      mesh.vertices.push_back({x, y, field.height(x, y)});
    }
  for (std::uint32_t j = 0; j + 1 < kNodes; ++j)
    for (std::uint32_t i = 0; i + 1 < kNodes; ++i) {
      const std::uint32_t v = j * kNodes + i;
      for (const std::uint32_t k : {v, v + 1, v + kNodes + 1, v, v + kNodes + 1, v + kNodes}) mesh.indices.push_back(k);
    }
  return mesh;
}

std::shared_ptr<const output::FluidPoints> fluidPoints(const fluid::Fluid& fluid) {
  auto points = std::make_shared<output::FluidPoints>();
  const fluid::FluidSnapshot now = fluid.snapshot();
  for (const base::Vec3d& p : now.position) points->position.push_back(p.as<float>());
  for (const base::Vec3d& v : now.velocity) points->velocity.push_back(v.as<float>());
  for (const double s : now.compression)
    points->pressure.push_back(static_cast<float>(fluid::pressureAt(fluid.model(), s)));
  points->spacing = fluid.model().spacing;
  return points;
}

void addGrains(output::Frame& frame, const terrain::Grains& grains, bool contactForces, bool known) {
  frame.withContactForces = contactForces;
  terrain::GrainSnapshot s = grains.snapshot({.contactForces = contactForces && known});
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (contactForces && !known) s.contactForce.assign(s.position.size(), {kNone, kNone, kNone});
  for (const base::Vec3d& p : s.position) frame.positions.push_back(p.as<float>());
  frame.ids = std::move(s.id);
  frame.velocities = std::move(s.velocity), frame.contactForces = std::move(s.contactForce);
  frame.borders = bordersOf(grains);
  frame.withFixed = grains.system().constants.has(terrain::kFixed);
  frame.fixed.assign(s.fixed.begin(), s.fixed.end());
  frame.radii = s.radius;
  if (s.radius.empty()) frame.radii.assign(s.position.size(), static_cast<float>(grains.model().radius));
}

} // namespace grouser::session

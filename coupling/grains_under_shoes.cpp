// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/grains_under_shoes.hpp"

#include "terrain/bed_tops.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::coupling {

namespace {

using base::Vec3d;

constexpr double kNodes = 6;       // nodes per grain radius, for the heights of stones
constexpr double kReach = 0.75;    // [node distance]: each stone is within reach of at least one node
constexpr double kClear = 1e-3;    // additional lift [radius]: accuracy of heights below tilted pads
constexpr double kLooksDown = 0.5; // minimum cosine between the vertical and the tread of a shoe [-]

struct Shoe {
  base::Pose pose; ///< X_WP
  Vec3d down;      ///< outward normal of its tread
};

std::vector<Shoe> shoesThatLookDown(const vehicle::Assembly& assembly) {
  std::vector<Shoe> shoes;
  for (const int index : assembly.groundParts) {
    const vehicle::Part& part = assembly.parts[static_cast<std::size_t>(index)];
    const base::Pose& body = assembly.model.bodies()[static_cast<std::size_t>(part.body)].pose;
    const base::Pose pose{body.toWorld(part.pose_B.position), body.orientation * part.pose_B.orientation};
    const Vec3d down = rotate(pose.orientation, Vec3d{0, 0, -1});
    if (-down.z > kLooksDown) shoes.push_back({pose, down});
  }
  return shoes;
}

} // namespace

double liftOffGrains(const vehicle::Assembly& assembly, const terrain::Grains& grains) {
  const std::vector<Shoe> shoes = shoesThatLookDown(assembly);
  if (shoes.empty()) return 0;
  const vehicle::ShoeSpec& spec = assembly.spec.shoe;
  const double r = grains.model().radius, spacing = r / kNodes;
  const double halfLength = spec.halfLength, halfWidth = spec.padHalfWidth;
  const double reach = halfLength + halfWidth + r;
  Vec3d low{1e300, 1e300, 0}, high{-1e300, -1e300, 0};
  for (const Shoe& s : shoes) {
    low = {std::min(low.x, s.pose.position.x - reach), std::min(low.y, s.pose.position.y - reach), 0};
    high = {std::max(high.x, s.pose.position.x + reach), std::max(high.y, s.pose.position.y + reach), 0};
  }
  const terrain::NodeGrid grid{static_cast<int>((high.x - low.x) / spacing) + 2,
                               static_cast<int>((high.y - low.y) / spacing) + 2,
                               spacing,
                               spacing,
                               low.x,
                               low.y};
  const std::vector<double> tops = terrain::highestTops(grains.system().exec, grains, grid, kReach * spacing);
  const double tread = spec.padBottom - spec.grouserHeight; // z of the lowest edges in the shoe's frame
  double lift = 0;
  for (const Shoe& s : shoes)
    grid.forEachWithin(s.pose.position.x, s.pose.position.y, reach, [&](std::size_t node) {
      if (!std::isfinite(tops[node])) return;
      const Vec3d at{grid.x(static_cast<int>(node % static_cast<std::size_t>(grid.columns))),
                     grid.y(static_cast<int>(node / static_cast<std::size_t>(grid.columns))), tops[node]};
      const Vec3d local = s.pose.toBody(at);
      // Beside the pad, the part of a sphere below the pad is lower than the top of the sphere.
      const double dx = std::max(0.0, std::fabs(local.x) - halfLength),
                   dy = std::max(0.0, std::fabs(local.y) - halfWidth);
      const double beside = std::max(0.0, std::sqrt(dx * dx + dy * dy) - kReach * spacing);
      if (beside >= r) return;
      const double lower = r - std::sqrt(r * r - beside * beside);
      lift = std::max(lift, (local.z - tread) / -s.down.z - lower);
    });
  return lift > 0 ? lift + kClear * r : 0;
}

} // namespace grouser::coupling

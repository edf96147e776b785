// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/floor_grains.hpp"

#include "base/random.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::terrain {

namespace {

constexpr std::uint64_t kFloorPlace = base::purpose("terrain.floor_grains.place");
constexpr std::uint64_t kFloorRadius = base::purpose("terrain.floor_grains.radius");
constexpr double kPitch = 2.0; // in mean radii
constexpr double kShift = 0.3; // maximum shift in each direction / pitch
constexpr double kSunk = 0.5;  // maximum depth of a centre below the floor / radius

/// Lattice positions along one axis.
struct Row {
  double start, pitch;
  std::int64_t count;
};

Row rowOf(double from, double to, double pitch) {
  const auto count = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor((to - from) / pitch + 0.5)));
  const double even = (to - from) / static_cast<double>(count);
  return {from + 0.5 * even, even, count};
}

double pitchOf(const FloorGrainOptions& o) { return kPitch * o.scale * o.radii.meanPower(1); }

} // namespace

std::int64_t floorGrainCount(const Rectangle& walls, const FloorGrainOptions& o) {
  return rowOf(walls.xMin, walls.xMax, pitchOf(o)).count * rowOf(walls.yMin, walls.yMax, pitchOf(o)).count;
}

std::vector<Seed> layFloorGrains(const HeightField& floor, const Rectangle& walls, const FloorGrainOptions& o) {
  const Row x = rowOf(walls.xMin, walls.xMax, pitchOf(o)), y = rowOf(walls.yMin, walls.yMax, pitchOf(o));
  std::vector<Seed> grains;
  grains.reserve(static_cast<std::size_t>(x.count * y.count));
  for (std::int64_t j = 0; j < y.count; ++j)
    for (std::int64_t i = 0; i < x.count; ++i) {
      const auto id = static_cast<std::uint64_t>(grains.size());
      const auto number = [&](std::uint64_t k) { return base::uniform(o.seed, kFloorPlace, id, k); };
      const double radius =
          o.scale * o.radii.draw([&](std::uint64_t k) { return base::uniform(o.seed, kFloorRadius, id, k); });
      base::Vec3d c{x.start + x.pitch * (static_cast<double>(i) + kShift * (2 * number(0) - 1)),
                    y.start + y.pitch * (static_cast<double>(j) + kShift * (2 * number(1) - 1)), 0};
      c.z = floor.height(c.x, c.y) - kSunk * radius * number(2);
      grains.push_back({c, radius, true});
    }
  return grains;
}

} // namespace grouser::terrain

// SPDX-License-Identifier: BSD-3-Clause
// Many grains from one section: lattices, random fills, files.
#include "base/error.hpp"
#include "base/random.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_kinds.hpp"

#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

namespace grouser::setup {

namespace {

using base::Vec3d;

constexpr std::uint64_t kPurpose = base::purpose("grains.block");
constexpr int kTries = 2000; // attempts to find a free position for one grain

/// Uniform random numbers for one grain of a [[grains]] section.
struct Dice {
  std::uint64_t seed, block, id, next = 0;
  double operator()() { return base::uniform(seed, kPurpose + block, id, next++); }
};

double drawRadius(const scene::GrainFill& b, Dice& dice) {
  return b.radiusTo ? *b.radius + dice() * (*b.radiusTo - *b.radius) : *b.radius;
}

scene::Grain grainAt(const scene::GrainFill& b, const Vec3d& position, double radius) {
  return {position, b.velocity, b.spin, radius, b.material};
}

/// Maximum shift of a lattice grain along each axis [m]; shifted grains do not touch.
double latticeShift(const scene::GrainFill& b) { return 0.5 * b.jitter * (b.spacing - 2) * b.largestRadius(); }

/// Number of lattice sites along each axis; shifted grains, too, are completely inside the box.
base::Vec3<std::int64_t> latticeCount(const scene::GrainFill& b) {
  const double pitch = b.spacing * b.largestRadius();
  base::Vec3<std::int64_t> count;
  for (int a = 0; a < 3; ++a) {
    const double room = (*b.high)[a] - (*b.low)[a] - 2 * (b.largestRadius() + latticeShift(b));
    count[a] = room < -1e-9 * pitch ? 0 : static_cast<std::int64_t>(std::floor(room / pitch + 1e-9)) + 1;
  }
  return count;
}

void addLattice(const scene::GrainFill& b, std::uint64_t seed, std::uint64_t block, std::vector<scene::Grain>& out) {
  const auto count = latticeCount(b);
  const double r = b.largestRadius(), pitch = b.spacing * r;
  const double shift = latticeShift(b);
  std::uint64_t id = 0;
  for (std::int64_t z = 0; z < count.z; ++z)
    for (std::int64_t y = 0; y < count.y; ++y)
      for (std::int64_t x = 0; x < count.x; ++x) {
        Dice dice{seed, block, id++};
        const double radius = drawRadius(b, dice);
        Vec3d place{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        for (int a = 0; a < 3; ++a) place[a] = (*b.low)[a] + r + shift + place[a] * pitch + (2 * dice() - 1) * shift;
        out.push_back(grainAt(b, place, radius));
      }
}

/// Places grains sequentially, each at the first free position among its random positions.
void addRandom(const scene::Scene& scene, const scene::GrainFill& b, std::uint64_t seed, std::uint64_t block,
               std::vector<scene::Grain>& out) {
  const double edge = 2 * b.largestRadius();
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;
  const auto cellOf = [&](const Vec3d& p, int a) {
    return static_cast<std::int64_t>(std::floor((p[a] - (*b.low)[a]) / edge));
  };
  const auto keyOf = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x & 0x1FFFFF) << 42 | static_cast<std::uint64_t>(y & 0x1FFFFF) << 21 |
           static_cast<std::uint64_t>(z & 0x1FFFFF);
  };
  const auto isFree = [&](const Vec3d& p, double radius) {
    const std::int64_t cx = cellOf(p, 0), cy = cellOf(p, 1), cz = cellOf(p, 2);
    for (std::int64_t x = cx - 1; x <= cx + 1; ++x)
      for (std::int64_t y = cy - 1; y <= cy + 1; ++y)
        for (std::int64_t z = cz - 1; z <= cz + 1; ++z) {
          const auto found = cells.find(keyOf(x, y, z));
          if (found == cells.end()) continue;
          for (const std::size_t other : found->second)
            if (norm(out[other].position - p) < 1.001 * (out[other].radius + radius)) return false;
        }
    return true;
  };
  for (std::int64_t k = 0; k < *b.number; ++k) {
    Dice dice{seed, block, static_cast<std::uint64_t>(k)};
    const double radius = drawRadius(b, dice);
    for (int attempt = 0;; ++attempt) {
      if (attempt == kTries)
        scene.fail(
            "grains", block, "number",
            fmt::format(
                "is too large; only {} grains fit into the box; enlarge the box (low, high), or lower the number", k));
      Vec3d place;
      for (int a = 0; a < 3; ++a) place[a] = (*b.low)[a] + radius + dice() * ((*b.high)[a] - (*b.low)[a] - 2 * radius);
      if (!isFree(place, radius)) continue;
      cells[keyOf(cellOf(place, 0), cellOf(place, 1), cellOf(place, 2))].push_back(out.size());
      out.push_back(grainAt(b, place, radius));
      break;
    }
  }
}

} // namespace

std::vector<scene::Grain> placedGrains(const scene::Scene& scene) {
  std::vector<scene::Grain> all = scene.grains;
  const auto seed = static_cast<std::uint64_t>(scene.run.seed);
  for (std::size_t k = 0; k < scene.fills.size(); ++k) {
    const scene::GrainFill& b = scene.fills[k];
    if (b.form == scene::FillForm::file) {
      all.insert(all.end(), b.fromFile.begin(), b.fromFile.end());
      continue;
    }
    std::vector<scene::Grain> own;
    if (b.form == scene::FillForm::lattice)
      addLattice(b, seed, k, own);
    else
      addRandom(scene, b, seed, k, own);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::int64_t placedCount(const scene::GrainFill& b) {
  if (b.form == scene::FillForm::file) return static_cast<std::int64_t>(b.fromFile.size());
  if (b.form == scene::FillForm::random) return *b.number;
  const base::Vec3<std::int64_t> n = latticeCount(b);
  return n.x * n.y * n.z;
}

std::int64_t placedCount(const scene::Scene& scene) {
  auto count = static_cast<std::int64_t>(scene.grains.size());
  for (const scene::GrainFill& b : scene.fills) count += placedCount(b);
  return count;
}

} // namespace grouser::setup

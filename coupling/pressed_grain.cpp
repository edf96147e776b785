// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/pressed_grain.hpp"

#include "terrain/feet_search.hpp"
#include "terrain/searched_height_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace grouser::coupling {

using base::Vec3d;

namespace {

/// Two contacts pinch the grain if the cosine between their normals is below kAgainst. The grain falls if the cosine
/// between its velocity and gravity is above kDownwards.
constexpr double kAgainst = -0.3, kDownwards = 0.8;

/// A sphere on some rank.
struct Found {
  Vec3d position, velocity;
  double radius;
};

std::optional<Found> findGrain(const terrain::Grains& grains, const terrain::GrainSnapshot& block, std::uint32_t id) {
  std::vector<Found> mine;
  const auto at = std::lower_bound(block.id.begin(), block.id.end(), id);
  if (at != block.id.end() && *at == id) {
    const auto i = static_cast<std::size_t>(at - block.id.begin());
    const Vec3d velocity = block.velocity[i].as<double>();
    mine.push_back({block.position[i], velocity,
                    block.radius.empty() ? grains.model().radius : static_cast<double>(block.radius[i])});
  }
  for (const std::vector<Found>& rank : grains.system().comm.gatherAll(mine))
    if (!rank.empty()) return rank.front();
  return std::nullopt;
}

/// Nearest image of the offset `apart` [m].
Vec3d nearestImage(Vec3d apart, const terrain::PeriodicBoundaries& sides) {
  for (int a = 0; a < 2; ++a)
    if (sides[static_cast<std::size_t>(a)]) {
      const auto& [from, to] = *sides[static_cast<std::size_t>(a)];
      apart[a] -= (to - from) * std::round(apart[a] / (to - from));
    }
  return apart;
}

/// Contact of a grain of this rank's block with the given grain.
struct Neighbour {
  std::uint64_t id;
  double overlap;
  Vec3d normal;
};

void addGrains(std::vector<PressedGrain::Presser>& by, const terrain::Grains& grains,
               const terrain::GrainSnapshot& block, const Found& own, std::uint32_t id,
               const terrain::PeriodicBoundaries& sides) {
  std::vector<Neighbour> mine;
  for (std::size_t i = 0; i < block.position.size(); ++i) {
    if (block.id[i] == id) continue;
    const Vec3d apart = nearestImage(own.position - block.position[i], sides);
    const double radius = block.radius.empty() ? grains.model().radius : static_cast<double>(block.radius[i]),
                 distance = norm(apart), overlap = own.radius + radius - distance;
    if (overlap > 0) mine.push_back({block.id[i], overlap, distance > 0 ? apart * (1 / distance) : Vec3d{}});
  }
  for (const std::vector<Neighbour>& rank : grains.system().comm.gatherAll(mine))
    for (const Neighbour& n : rank) by.push_back({fmt::format("grain {}", n.id), n.overlap, n.normal, false});
}

void addRigid(std::vector<PressedGrain::Presser>& by, const GroundSetup& setup,
              const std::function<base::Pose(std::size_t)>& surfacePose, const Found& own) {
  const terrain::Boundaries& around = setup.grains->boundaries;
  const auto add = [&by](const std::string& name, double overlap, const Vec3d& normal) {
    if (overlap > 0) by.push_back({name, overlap, normal, true});
  };
  for (std::size_t w = 0; w < around.walls.size(); ++w)
    add(setup.grains->wallNames[w], own.radius - dot(around.walls[w].normal, own.position) + around.walls[w].offset,
        around.walls[w].normal);
  if (around.floor) {
    const terrain::SearchedHeightField floor(base::Exec{}, *around.floor, own.radius);
    terrain::FootPoint foot;
    if (terrain::deepestFoot(floor.view(), own.position, own.radius, foot))
      add("the terrain's floor", own.radius - foot.distance, {});
  }
  for (std::size_t i = 0; i < setup.surfaces.size(); ++i) {
    const SurfaceSetup& s = setup.surfaces[i];
    if (s.mesh) continue;
    const base::Pose pose = surfacePose(i);
    const terrain::SurfaceGap gap = terrain::gapTo(s.geometry, pose.toBody(own.position));
    add(fmt::format("{} '{}'", base::wordOf(s.kind), s.name), own.radius - gap.distance,
        rotate(pose.orientation, gap.normal));
  }
}

} // namespace

PressedGrain pressedGrain(const terrain::Grains& grains, const GroundSetup& setup,
                          const std::function<base::Pose(std::size_t)>& surfacePose, std::uint32_t id) {
  const terrain::GrainSnapshot block = grains.snapshot();
  const std::optional<Found> own = findGrain(grains, block, id);
  if (!own) return {};
  PressedGrain pressed{own->position, own->velocity, own->radius, {}};
  addGrains(pressed.by, grains, block, *own, id, setup.grains->boundaries.periodic);
  addRigid(pressed.by, setup, surfacePose, *own);
  std::sort(pressed.by.begin(), pressed.by.end(), [](const auto& a, const auto& b) { return a.overlap > b.overlap; });
  return pressed;
}

std::string PressedGrain::sentence() const {
  const auto named = [](const Presser& p) { return fmt::format("{} ({:.2g} mm)", p.name, 1e3 * p.overlap); };
  for (std::size_t j = 1; j < by.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (dot(by[i].normal, by[j].normal) < kAgainst)
        return fmt::format("it is pinched between {} and {}", named(by[i]), named(by[j]));
  constexpr std::size_t kMaxNamed = 3;
  std::string all;
  for (std::size_t i = 0; i < std::min(kMaxNamed, by.size()); ++i)
    all += (i == 0 ? "it is pressed by " : ", ") + named(by[i]);
  return all;
}

const PressedGrain::Presser* PressedGrain::rigidPresser() const {
  const Presser* most = nullptr;
  for (const Presser& p : by)
    if (p.rigid && (!most || p.overlap > most->overlap)) most = &p;
  return most;
}

bool PressedGrain::fallsFreely(const Vec3d& gravity) const {
  return by.empty() && norm(gravity) > 0 && dot(velocity, gravity) > kDownwards * norm(velocity) * norm(gravity);
}

} // namespace grouser::coupling

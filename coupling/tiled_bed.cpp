// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/tiled_bed.hpp"

#include <algorithm>
#include <utility>

namespace grouser::coupling {

TiledBed::TiledBed(const TileSetup& tile, const terrain::Grains& settled, const terrain::HeightField& surface)
    : periodic_(tile.periodic), copies_(tile.copies), scale_(settled.scale()), radius_(settled.model().radius),
      period_(settled.system().constants.period), tile_(settled.state()) {
  // The tile covers [0, size x] and [-size y / 2, size y / 2], like every terrain.
  lift_ = base::toUnits(scale_.fromMetres(
      {0, 0.5 * tile.size[1] - 0.5 * tile.terrainSize[1], tile.floorHeight - tile.ground->rigid->bounds().lowest}));

  const auto clear = [&](std::size_t a, double x, double low, double high, double radius) {
    return periodic_[a] || (x >= low + radius && x <= high - radius);
  };
  const terrain::HeightFieldBounds top = surface.bounds();
  const bool level = top.highest - top.lowest <= 1e-6 * radius_;
  for (std::int64_t i = 0; i < copies_[0]; ++i)
    for (std::int64_t j = 0; j < copies_[1]; ++j)
      for (std::size_t g = 0; g < tile_.rows(); ++g) {
        const Copy copy{{i, j}, g};
        const base::Vec3d x = scale_.toMetres(base::fromUnits(place(copy)));
        const double radius = isFixed(g) ? 0 : radiusOf(g); // fixed grains may overlap a wall
        const bool stays = clear(0, x.x, tile.walls.xMin, tile.walls.xMax, radius) &&
                           clear(1, x.y, tile.walls.yMin, tile.walls.yMax, radius) &&
                           (level || x.z <= surface.height(x.x, x.y));
        id_.push_back(stays ? static_cast<std::int64_t>(grains_.size()) : -1);
        if (stays) grains_.push_back(copy);
      }
}

base::Vec3l TiledBed::place(const Copy& copy) const {
  base::Vec3l u = base::toUnits(tile_.position[copy.grain]) + lift_;
  for (int a = 0; a < 2; ++a) u[a] += copy.tile[static_cast<std::size_t>(a)] * period_.length[a];
  return u;
}

std::int64_t TiledBed::idOf(std::array<std::int64_t, 2> tile, std::size_t grain) const {
  for (std::size_t a = 0; a < 2; ++a) {
    if (periodic_[a]) tile[a] = (tile[a] + copies_[a]) % copies_[a];
    if (tile[a] < 0 || tile[a] >= copies_[a]) return -1;
  }
  return id_[static_cast<std::size_t>(tile[0] * copies_[1] + tile[1]) * tile_.rows() + grain];
}

std::vector<terrain::GrainSpec> TiledBed::start(int material) const {
  std::vector<terrain::GrainSpec> start;
  start.reserve(grains_.size());
  for (const Copy& copy : grains_)
    start.push_back(
        {scale_.toMetres(base::fromUnits(place(copy))), {}, {}, radiusOf(copy.grain), material, isFixed(copy.grain)});
  return start;
}

void TiledBed::bringToRest(terrain::Grains& grains, std::size_t floor) const {
  terrain::GrainState s = grains.state(); // this rank's block of ids, without contacts
  std::vector<std::size_t> first(tile_.rows() + 1);
  for (std::size_t g = 0; g < tile_.rows(); ++g) first[g + 1] = first[g] + tile_.contacts[g];
  const auto boundaries = static_cast<std::size_t>(s.layout.boundaries);
  for (std::size_t k = 0; k < s.rows(); ++k) {
    const Copy& copy = grains_[s.id[k]];
    const std::size_t g = copy.grain;
    s.velocity[k] = tile_.velocity[g], s.spin[k] = tile_.spin[g], s.remainders[k] = tile_.remainders[g];
    // The tile has one boundary, its floor.
    if (tile_.wallBits[g] & 1u) s.wallBits[k] |= 1u << floor;
    if (!tile_.wallShear.empty()) s.wallShear[k * boundaries + floor] = tile_.wallShear[g];
    if (!tile_.wallRolling.empty()) s.wallRolling[k * boundaries + floor] = tile_.wallRolling[g];
    if (!tile_.wallDeepest.empty()) {
      s.wallDeepest[k * boundaries + floor] = tile_.wallDeepest[g];
      s.wallOrigin[k * boundaries + floor] = tile_.wallOrigin[g];
    }

    std::vector<std::pair<std::int64_t, std::size_t>> touching; // neighbour, and its contact in the tile
    for (std::size_t c = first[g]; c < first[g + 1]; ++c) {
      const std::size_t other = tile_.neighbour[c];
      const base::Vec3l here = base::toUnits(tile_.position[g]), there = base::toUnits(tile_.position[other]);
      const base::Vec3l image = here + period_.apart(tile_.position[g], tile_.position[other]);
      std::array<std::int64_t, 2> tile = copy.tile;
      for (int a = 0; a < 2; ++a) tile[static_cast<std::size_t>(a)] += (image[a] - there[a]) / period_.length[a];
      if (const std::int64_t id = idOf(tile, other); id >= 0) touching.emplace_back(id, c);
    }
    std::sort(touching.begin(), touching.end());
    s.contacts[k] = static_cast<std::uint32_t>(touching.size());
    for (const auto& [id, c] : touching) {
      s.neighbour.push_back(static_cast<std::uint32_t>(id));
      if (s.layout.friction) s.contactShear.push_back(tile_.contactShear[c]);
      if (s.layout.rolling) s.contactRolling.push_back(tile_.contactRolling[c]);
      if (s.layout.plastic) {
        s.contactDeepest.push_back(tile_.contactDeepest[c]);
        s.contactOrigin.push_back(tile_.contactOrigin[c]);
      }
    }
  }
  grains.restore(s);
}

} // namespace grouser::coupling

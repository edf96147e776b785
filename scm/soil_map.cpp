// SPDX-License-Identifier: BSD-3-Clause
#include "scm/soil_map.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::scm {

SoilMap::Tile& SoilMap::make(std::int32_t tileX, std::int32_t tileY) {
  auto tile = std::make_unique<Tile>();
  for (int j = 0; j < kTile; ++j)
    for (int i = 0; i < kTile; ++i) {
      const terrain::SurfaceJet jet = surface_(spacing_ * (tileX * kTile + i), spacing_ * (tileY * kTile + j));
      Node& node = tile->nodes[placeInTile(i, j)];
      node.height = jet.h, node.cosine = 1 / std::sqrt(1 + jet.hx * jet.hx + jet.hy * jet.hy);
      tile->top = std::max(tile->top, jet.h);
    }
  return *(tiles_[key(tileX, tileY)] = std::move(tile));
}

double SoilMap::topOf(std::int32_t i0, std::int32_t i1, std::int32_t j0, std::int32_t j1) {
  double top = -base::kInfinity;
  for (std::int32_t j = tileAt(j0); j <= tileAt(j1); ++j)
    for (std::int32_t i = tileAt(i0); i <= tileAt(i1); ++i) top = std::max(top, tileOf(i, j).top);
  return top + maxLoose_;
}

const Node* SoilMap::find(std::int32_t i, std::int32_t j) const {
  const auto found = tiles_.find(key(i >> kShift, j >> kShift));
  return found == tiles_.end() ? nullptr : &found->second->nodes[placeInTile(i, j)];
}

double SoilMap::rutAt(double x, double y) const {
  return interpolate(x, y, spacing_, [&](std::int32_t i, std::int32_t j) {
    const Node* node = find(i, j);
    return node ? node->rut() : 0;
  });
}

double SoilMap::surfaceAt(double x, double y) {
  return interpolate(x, y, spacing_, [&](std::int32_t i, std::int32_t j) { return at(i, j).surface(); });
}

void SoilMap::forEach(const std::function<void(std::int32_t, std::int32_t, const Node&)>& look) const {
  std::vector<std::pair<std::int32_t, std::int32_t>> places; // row, column of tiles
  for (const auto& [k, tile] : tiles_)
    places.emplace_back(static_cast<std::int32_t>(k >> 32), static_cast<std::int32_t>(k & 0xffffffff));
  std::sort(places.begin(), places.end());
  for (const auto& [y, x] : places) {
    const Tile& tile = *tiles_.at(key(x, y));
    for (int n = 0; n < kTile * kTile; ++n)
      look(x * kTile + n % kTile, y * kTile + n / kTile, tile.nodes[static_cast<std::size_t>(n)]);
  }
}

} // namespace grouser::scm

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
    }
  return *(tiles_[key(tileX, tileY)] = std::move(tile));
}

const Node* SoilMap::find(std::int32_t i, std::int32_t j) const {
  const auto found = tiles_.find(key(i >> kShift, j >> kShift));
  return found == tiles_.end() ? nullptr : &found->second->nodes[placeInTile(i, j)];
}

double SoilMap::rutAt(double x, double y) const {
  const auto i = static_cast<std::int32_t>(std::floor(x / spacing_)), j = static_cast<std::int32_t>(std::floor(y / spacing_));
  const double u = x / spacing_ - i, v = y / spacing_ - j;
  const auto depth = [&](std::int32_t column, std::int32_t row) {
    const Node* node = find(column, row);
    return node ? node->state.rebound() / node->cosine : 0; // vertical, whereas sinkage is along the normal
  };
  return (1 - v) * ((1 - u) * depth(i, j) + u * depth(i + 1, j)) +
         v * ((1 - u) * depth(i, j + 1) + u * depth(i + 1, j + 1));
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

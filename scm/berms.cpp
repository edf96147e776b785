// SPDX-License-Identifier: BSD-3-Clause
#include "scm/berms.hpp"

#include "scm/number_stream.hpp"

#include <cmath>

namespace grouser::scm {

namespace {

constexpr double kSettled = 1e-4; // [m] excess height of a pair below which it counts as at rest

/// Converts loose soil compacted under a body to loose soil of its current thickness.
void loosen(Node& node) {
  if (!(node.loose.stiffness > 0)) return;
  node.looseQuanta -= static_cast<std::int64_t>(std::ceil(node.loose.rebound() / node.cosine / kHeightQuantum));
  if (node.looseQuanta < 0) node.looseQuanta = 0;
  node.loose = {};
}

} // namespace

void Berms::deposit(Node& from, double x, double y, double dx, double dy) {
  const auto quanta = static_cast<std::int64_t>(from.displaced / kHeightQuantum);
  if (quanta <= 0) return;
  const double h = map_.spacing();
  for (int n = 1; n <= kFarthest; ++n) {
    const auto i = static_cast<std::int32_t>(std::lround((x + n * h * dx) / h));
    const auto j = static_cast<std::int32_t>(std::lround((y + n * h * dy) / h));
    Node& node = map_.at(i, j);
    if (node.touched >= 0) continue;
    loosen(node);
    map_.addLoose(node, quanta), moved_ += quanta;
    from.displaced -= static_cast<double>(quanta) * kHeightQuantum;
    active_.emplace(SoilMap::tileAt(j), SoilMap::tileAt(i));
    return;
  }
}

void Berms::slide() {
  if (active_.empty()) return;
  std::set<Place> next;
  // Pairs are in four classes; no two pairs of a class share a node, so the order within a class has no effect.
  for (const auto& [di, dj] : {std::pair{1, 0}, std::pair{0, 1}})
    for (int parity = 0; parity < 2; ++parity)
      for (const auto& [tileJ, tileI] : active_)
        for (std::int32_t b = -dj; b < SoilMap::kTile; ++b)
          for (std::int32_t a = -di; a < SoilMap::kTile; ++a) {
            const std::int32_t i = tileI * SoilMap::kTile + a, j = tileJ * SoilMap::kTile + b;
            if (((di ? i : j) & 1) == parity) slide(i, j, di, dj, next);
          }
  active_ = std::move(next);
}

void Berms::slide(std::int32_t i, std::int32_t j, std::int32_t di, std::int32_t dj, std::set<Place>& active) {
  Node &a = map_.at(i, j), &b = map_.at(i + di, j + dj);
  if (a.looseQuanta == 0 && b.looseQuanta == 0) return;
  if (a.touched >= 0 || b.touched >= 0) return;
  const double fall = a.surface() - b.surface(), excess = std::fabs(fall) - steepest_;
  if (!(excess > kSettled)) return;
  Node &high = fall > 0 ? a : b, &low = fall > 0 ? b : a;
  if (high.looseQuanta == 0) return;
  loosen(high), loosen(low);
  const auto half = static_cast<std::int64_t>(0.25 * excess / kHeightQuantum); // halves the excess
  const std::int64_t quanta = std::min(half, high.looseQuanta);
  map_.addLoose(high, -quanta), map_.addLoose(low, quanta);
  active.emplace(SoilMap::tileAt(j), SoilMap::tileAt(i));
  active.emplace(SoilMap::tileAt(j + dj), SoilMap::tileAt(i + di));
}

void Berms::save(NumberStream& numbers) const {
  std::int64_t moved = moved_;
  std::vector<Place> places(active_.begin(), active_.end());
  numbers(moved), numbers.size(places);
  for (auto& [row, column] : places) numbers(row, column);
}

void Berms::restore(NumberStream& numbers) {
  std::vector<Place> places;
  numbers(moved_), numbers.size(places);
  for (auto& [row, column] : places) numbers(row, column);
  active_ = {places.begin(), places.end()};
}

} // namespace grouser::scm

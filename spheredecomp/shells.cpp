// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/shells.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grouser::spheredecomp {

namespace {

constexpr double kPointsInDiagonal = 40;
constexpr double kBesideSurface = 2.5e-5; // distance of the points from the surface [diagonal]
constexpr double kFaultyArea = 1e-3;      // permitted share of the area: faces that touch within rounding
constexpr int kMaxPieces = 40;            // along an edge of a triangle

/// Calls f(centre) for n^2 similar pieces of equal area.
template <class F> void forEachPiece(const std::array<Vec3d, 3>& corners, int n, F f) {
  const Vec3d u = (corners[1] - corners[0]) * (1.0 / n), v = (corners[2] - corners[0]) * (1.0 / n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      f(corners[0] + u * (i + 1.0 / 3) + v * (j + 1.0 / 3));
      if (i + j + 1 < n) f(corners[0] + u * (i + 2.0 / 3) + v * (j + 2.0 / 3));
    }
}

} // namespace

std::optional<ShellFault> shellFault(const MeshQuery& query) {
  const auto [low, high] = bounds(query.mesh());
  const double diagonal = norm(high - low), spacing = diagonal / kPointsInDiagonal;
  std::array<ShellFault, 2> faults{ShellFault{ShellFault::Kind::overlap, {}, 0}, {ShellFault::Kind::inverted, {}, 0}};
  std::array<double, 2> largest{};
  double total = 0;
  const auto count = [&](std::size_t kind, const Vec3d& at, double piece) {
    faults[kind].share += piece;
    if (piece > largest[kind]) largest[kind] = piece, faults[kind].place = at;
  };
  for (std::uint32_t t = 0; t < query.mesh().indices.size() / 3; ++t) {
    const std::array<Vec3d, 3> corners{query.vertex(t, 0), query.vertex(t, 1), query.vertex(t, 2)};
    const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const double area = 0.5 * norm(cross(ab, ac)), longest = std::max({norm(ab), norm(ac), norm(ac - ab)});
    if (!(area > 0)) continue;
    total += area;
    const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMaxPieces);
    const double piece = area / (n * n);
    const Vec3d step = query.normal(t) * (kBesideSurface * diagonal);
    forEachPiece(corners, n, [&](const Vec3d& at) {
      if (query.winding(at - step) > 1) count(0, at, piece);
      if (query.winding(at + step) < 0) count(1, at, piece);
    });
  }
  for (ShellFault& fault : faults)
    if (fault.share > kFaultyArea * total) {
      fault.share /= total;
      return fault;
    }
  return {};
}

} // namespace grouser::spheredecomp

// SPDX-License-Identifier: BSD-3-Clause
#include "contact/partition.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::contact {

namespace {

/// Planes between `parts` slabs of nearly equal weight. Strictly ascending, so that no two planes coincide even if all
/// the weight is in one bin.
std::vector<std::int64_t> migrate(int parts, std::int64_t low, std::int64_t high,
                                  const std::vector<std::int64_t>& weights) {
  std::int64_t total = 0;
  for (const std::int64_t w : weights) total += w;
  const auto bins = static_cast<std::int64_t>(weights.size());
  const std::int64_t width = binWidth(low, high, bins);
  std::vector<std::int64_t> cuts;
  std::int64_t before = 0, bin = 0;
  for (std::int64_t part = 1; part < parts; ++part) {
    const std::int64_t wanted = total / parts * part;
    while (bin < bins && before + weights[static_cast<std::size_t>(bin)] <= wanted)
      before += weights[static_cast<std::size_t>(bin++)];
    // The weight is assumed uniform within the bin.
    const std::int64_t inBin = bin < bins ? weights[static_cast<std::size_t>(bin)] : 0;
    const double share = inBin > 0 ? static_cast<double>(wanted - before) / static_cast<double>(inBin) : 0.0;
    std::int64_t cut = low + bin * width + static_cast<std::int64_t>(share * static_cast<double>(width));
    if (!cuts.empty()) cut = std::max(cut, cuts.back() + 1);
    cuts.push_back(cut);
  }
  return cuts;
}

} // namespace

Partition::Partition(const std::array<int, 3>& shape, const base::Vec3l& low, const base::Vec3l& high,
                     const std::array<std::vector<std::int64_t>, 3>& weights)
    : shape_(shape) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (shape[a] < 1 || shape[a] > kMaxSubdomainsAnAxis)
      throw base::InputError(
          fmt::format("the number of subdomains along {}, {}, is outside [1, {}]; change parallel.subdomains", "xyz"[a],
                      shape[a], kMaxSubdomainsAnAxis));
    cuts_[a] = migrate(shape[a], low[static_cast<int>(a)], high[static_cast<int>(a)], weights[a]);
  }
}

Partition::Partition(const std::array<std::vector<std::int64_t>, 3>& cuts) : cuts_(cuts) {
  for (std::size_t a = 0; a < 3; ++a) shape_[a] = static_cast<int>(cuts[a].size()) + 1;
}

PartitionView Partition::view() const {
  PartitionView v{};
  for (std::size_t a = 0; a < 3; ++a) {
    v.shape[a] = shape_[a];
    std::copy(cuts_[a].begin(), cuts_[a].end(), v.cut[a]);
  }
  return v;
}

std::array<int, 3> latticeShape(int ranks, const std::array<double, 3>& size, const std::array<int, 3>& wanted) {
  std::array<int, 3> best{};
  double least = 0;
  for (int x = 1; x <= ranks; ++x)
    for (int y = 1; ranks % x == 0 && y <= ranks / x; ++y) {
      if (ranks / x % y != 0) continue;
      const std::array<int, 3> shape{x, y, ranks / x / y};
      bool fits = true;
      for (std::size_t a = 0; a < 3; ++a)
        fits = fits && (wanted[a] == 0 || wanted[a] == shape[a]) && shape[a] <= kMaxSubdomainsAnAxis;
      if (!fits) continue;
      double area = 0;
      for (std::size_t a = 0; a < 3; ++a) area += (shape[a] - 1) * size[(a + 1) % 3] * size[(a + 2) % 3];
      if (best[0] == 0 || area < least) best = shape, least = area;
    }
  if (best[0] == 0)
    throw base::InputError(
        fmt::format("{} ranks cannot form a lattice of [{}, {}, {}] subdomains (0: any number up to {}), "
                    "one per rank; change parallel.subdomains, or mpirun -np",
                    ranks, wanted[0], wanted[1], wanted[2], kMaxSubdomainsAnAxis));
  return best;
}

} // namespace grouser::contact

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/position.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace grouser::contact {

inline constexpr int kMaxSubdomainsAnAxis = 64;

/// Kernel view of a partition: the planes between subdomains, ascending along each axis.
struct PartitionView {
  int shape[3];
  std::int64_t cut[3][kMaxSubdomainsAnAxis - 1]; ///< [units]

  /// Index along one axis of the subdomain that contains coordinate `u`.
  GROUSER_HD int along(int axis, std::int64_t u) const {
    int k = 0;
    while (k < shape[axis] - 1 && u >= cut[axis][k]) ++k;
    return k;
  }
  GROUSER_HD int rankAt(int x, int y, int z) const { return (x * shape[1] + y) * shape[2] + z; }
  GROUSER_HD int ownerOf(const base::Vec3l& u) const { return rankAt(along(0, u.x), along(1, u.y), along(2, u.z)); }
};

/// Partition of space into a Cartesian grid of subdomains, one per rank. The outer subdomains extend to infinity, so
/// every element has exactly one owner: the subdomain that contains its centre.
class Partition {
public:
  /// Partition with a single subdomain.
  Partition() = default;
  /// `weights` [axis][bin]: work in equal bins from `low` to `high` on each axis; the cuts divide it evenly among the
  /// slabs of each axis.
  Partition(const std::array<int, 3>& shape, const base::Vec3l& low, const base::Vec3l& high,
            const std::array<std::vector<std::int64_t>, 3>& weights);

  /// Partition with planes at these coordinates [units], ascending along each axis.
  explicit Partition(const std::array<std::vector<std::int64_t>, 3>& cuts);

  int count() const { return shape_[0] * shape_[1] * shape_[2]; }
  const std::array<int, 3>& shape() const { return shape_; }
  const std::vector<std::int64_t>& cuts(int axis) const { return cuts_[static_cast<std::size_t>(axis)]; } ///< [units]
  PartitionView view() const;
  bool operator==(const Partition&) const = default;

private:
  std::array<int, 3> shape_{1, 1, 1};
  std::array<std::vector<std::int64_t>, 3> cuts_;
};

/// Returns the grid of `ranks` subdomains with the minimum cut area through a box of this size (any unit), among all
/// factorisations that match `wanted` (0: any number on that axis). Throws InputError if `wanted` is incompatible with
/// `ranks`.
std::array<int, 3> latticeShape(int ranks, const std::array<double, 3>& size,
                                const std::array<int, 3>& wanted = {0, 0, 0});

/// Number of histogram bins for the cuts.
inline constexpr int kPartitionBins = 4096;

/// Width of `bins` equal bins that cover `low` to `high` [units].
inline std::int64_t binWidth(std::int64_t low, std::int64_t high, std::int64_t bins = kPartitionBins) {
  return std::max<std::int64_t>(1, (high - low) / bins + 1);
}

} // namespace grouser::contact

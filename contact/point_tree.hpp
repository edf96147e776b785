// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_surface.hpp"
#include "contact/patch_lanes.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::contact {

/// Up to eight neighbouring surface points of a part, in the part frame. Idle lanes have zero area.
struct alignas(64) PointBlock {
  Vec3P place;       ///< [m]
  PointLanes radius; ///< radius of the point's ball [m]; 0: a point on the surface itself
  PointLanes area;   ///< [m2]
  int count;         ///< number of active lanes
};

/// Bounding-box tree of the surface points of a part, for contact with rigid surfaces on the host.
class PointTree {
public:
  /// Bounding box of a group of points with their balls. Nodes are stored depth first.
  struct Node {
    base::Vec3d centre, half; ///< [m]
    std::uint32_t behind;     ///< index of the next node if this box is skipped
    std::int32_t block;       ///< index of the block; -1: child boxes follow
  };

  PointTree() = default;
  explicit PointTree(const std::vector<SurfaceSample>& samples);

  const std::vector<Node>& nodes() const { return nodes_; }
  const PointBlock& block(std::int32_t i) const { return blocks_[static_cast<std::size_t>(i)]; }
  std::size_t blocks() const { return blocks_.size(); }
  /// Cluster c (SurfaceSample::cluster) consists of the nodes [firstNode(c), firstNode(c + 1)).
  std::uint32_t firstNode(int cluster) const { return first_[static_cast<std::size_t>(cluster)]; }
  double reach() const { return reach_; }   ///< bounding radius about the origin of the part frame [m]
  double widest() const { return widest_; } ///< maximum point radius [m]

private:
  void split(std::vector<SurfaceSample>& samples, std::size_t from, std::size_t to);

  std::vector<Node> nodes_;
  std::vector<PointBlock> blocks_;
  std::array<std::uint32_t, kClusters + 1> first_{};
  double reach_{0}, widest_{0};
};

} // namespace grouser::contact

// SPDX-License-Identifier: BSD-3-Clause
#include "contact/point_tree.hpp"

#include <algorithm>

namespace grouser::contact {

using base::Vec3d;

namespace {

double along(const SurfaceSample& s, int axis) { return static_cast<double>(s.centre[axis]); }

} // namespace

PointTree::PointTree(const std::vector<SurfaceSample>& samples) {
  for (int c = 0; c < kClusters; ++c) {
    first_[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(nodes_.size());
    std::vector<SurfaceSample> of;
    for (const SurfaceSample& s : samples)
      if (static_cast<int>(s.cluster) == c) of.push_back(s);
    if (!of.empty()) split(of, 0, of.size());
  }
  first_.back() = static_cast<std::uint32_t>(nodes_.size());
  for (const SurfaceSample& s : samples) {
    reach_ = std::max(reach_, norm(s.centre.as<double>()) + static_cast<double>(s.radius));
    widest_ = std::max(widest_, static_cast<double>(s.radius));
  }
}

/// Builds the node of samples [from, to) and, recursively, its children.
void PointTree::split(std::vector<SurfaceSample>& samples, std::size_t from, std::size_t to) {
  Vec3d low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30}, first = low, last = high;
  for (std::size_t i = from; i < to; ++i) {
    const Vec3d c = samples[i].centre.as<double>();
    const double r = static_cast<double>(samples[i].radius);
    low = min(low, c - Vec3d{r, r, r}), high = max(high, c + Vec3d{r, r, r});
    first = min(first, c), last = max(last, c);
  }
  const std::size_t node = nodes_.size();
  nodes_.push_back({(low + high) * 0.5, (high - low) * 0.5, 0, -1});
  if (to - from <= kPointLanes) {
    nodes_[node].block = static_cast<std::int32_t>(blocks_.size());
    PointBlock block{};
    block.count = static_cast<int>(to - from);
    for (std::size_t l = 0; l < kPointLanes; ++l) {
      const bool idle = from + l >= to;
      const SurfaceSample& s = samples[idle ? from : from + l];
      block.place.x[l] = along(s, 0), block.place.y[l] = along(s, 1), block.place.z[l] = along(s, 2);
      block.radius[l] = static_cast<double>(s.radius), block.area[l] = idle ? 0 : static_cast<double>(s.area);
    }
    blocks_.push_back(block);
  } else {
    const Vec3d size = last - first;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::stable_sort(
        samples.begin() + static_cast<std::ptrdiff_t>(from), samples.begin() + static_cast<std::ptrdiff_t>(to),
        [axis](const SurfaceSample& a, const SurfaceSample& b) { return along(a, axis) < along(b, axis); });
    // The left child receives full blocks, which minimises idle lanes.
    const std::size_t half = (to - from) / 2, left = std::max<std::size_t>(half / kPointLanes, 1) * kPointLanes;
    split(samples, from, from + left);
    split(samples, from + left, to);
  }
  nodes_[node].behind = static_cast<std::uint32_t>(nodes_.size());
}

} // namespace grouser::contact

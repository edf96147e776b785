// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/soil_result.hpp"

#include "scm/soil_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grouser::output {

namespace {

using coupling::GroundFields;
using coupling::SoilNode;

constexpr std::uint64_t kMaxNodes = 4'000'000; ///< maximum number of nodes of a map
constexpr double kSectionLength = 0.5;         ///< length of the rut over which the cross section is averaged [m]
constexpr double kBeside = 0.3;                ///< width of undisturbed soil on each side of the rut in a section [m]

double sinkageAt(const GroundFields& fields, std::int32_t i, std::int32_t j) {
  const auto at =
      std::lower_bound(fields.nodes.begin(), fields.nodes.end(), std::pair(j, i),
                       [](const SoilNode& node, const auto& place) { return std::pair(node.j, node.i) < place; });
  return at != fields.nodes.end() && at->i == i && at->j == j ? at->sinkage : 0;
}

/// Sinkage at a point, interpolated between nodes.
double sinkageAt(const GroundFields& fields, const base::Vec3d& p) {
  return scm::interpolate(p.x, p.y, fields.spacing,
                          [&](std::int32_t i, std::int32_t j) { return sinkageAt(fields, i, j); });
}

/// Maps over the rectangle of all nodes.
void addMaps(SoilResult& result, const GroundFields& fields) {
  std::int64_t iMin = std::numeric_limits<std::int32_t>::max(), iMax = std::numeric_limits<std::int32_t>::min();
  for (const SoilNode& node : fields.nodes)
    iMin = std::min<std::int64_t>(iMin, node.i), iMax = std::max<std::int64_t>(iMax, node.i);
  const std::int64_t jMin = fields.nodes.front().j, jMax = fields.nodes.back().j;
  std::int64_t stride = 0;
  do {
    ++stride;
    result.columns = static_cast<std::uint64_t>((iMax - iMin) / stride + 1);
    result.rows = static_cast<std::uint64_t>((jMax - jMin) / stride + 1);
  } while (result.columns * result.rows > kMaxNodes);
  const auto lengthOf = [&](std::int64_t nodes) { return static_cast<double>(nodes) * fields.spacing; };
  result.origin = {lengthOf(iMin), lengthOf(jMin)}, result.spacing = {lengthOf(stride)};
  for (const SoilMapField& map : kSoilMaps) (result.*map.member).assign(result.columns * result.rows, 0);
  for (const SoilNode& node : fields.nodes) {
    if ((node.i - iMin) % stride != 0 || (node.j - jMin) % stride != 0) continue;
    const auto at = static_cast<std::size_t>((node.j - jMin) / stride) * result.columns +
                    static_cast<std::size_t>((node.i - iMin) / stride);
    result.sinkage[at] = static_cast<float>(node.sinkage), result.pressure[at] = static_cast<float>(node.pressure);
    result.shear[at] = static_cast<float>(norm(node.shear));
    result.maxPressure[at] = static_cast<float>(node.maxPressure);
  }
}

void addSection(SoilResult& result, const GroundFields& fields, const base::Vec3d& position,
                const base::Vec3d& heading) {
  const base::Vec3d left{-heading.y, heading.x, 0};
  double front = -1e300, rear = 1e300, end = 1e300, half = 0; // along and across the heading, from `position` [m]
  for (const SoilNode& node : fields.nodes) {
    const base::Vec3d p = base::Vec3d{node.i * fields.spacing, node.j * fields.spacing, position.z} - position;
    const double along = dot(p, heading);
    end = std::min(end, along);
    if (!(node.pressure > 0)) continue;
    front = std::max(front, along), rear = std::min(rear, along), half = std::max(half, std::fabs(dot(p, left)));
  }
  if (front < rear) return;                                                       // no node is loaded
  double from = std::max(end, rear - kSectionLength), to = rear - fields.spacing; // unloaded nodes
  if (to - from < 2 * fields.spacing) from = rear, to = front;
  const int samples = std::max(1, static_cast<int>((to - from) / fields.spacing));
  const int offsets = static_cast<int>((half + kBeside) / fields.spacing);
  for (int k = -offsets; k <= offsets; ++k) {
    const double offset = k * fields.spacing;
    double sum = 0;
    for (int s = 0; s < samples; ++s)
      sum += sinkageAt(fields, position + left * offset + heading * (from + (to - from) * (s + 0.5) / samples));
    result.sectionOffset.push_back(offset), result.sectionSinkage.push_back(sum / samples);
  }
}

} // namespace

SoilResult soilResult(const GroundFields& fields, const std::optional<Course>& course) {
  SoilResult result;
  result.constants = fields.constants;
  if (fields.nodes.empty()) return result;
  addMaps(result, fields);
  if (course) addSection(result, fields, course->position, course->heading);
  return result;
}

} // namespace grouser::output

// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/contact_parts.hpp"

namespace grouser::coupling {

std::vector<int> ContactParts::surfaceOfPart() const {
  std::vector<int> all;
  for (const ContactPart& part : parts) all.push_back(part.surface);
  return all;
}

std::vector<contact::PartBody> ContactParts::massOfParts() const {
  std::vector<contact::PartBody> all;
  for (const ContactPart& part : parts) all.push_back(part.massOf);
  return all;
}

std::vector<int> ContactParts::pointsOfPart() const {
  std::vector<int> all;
  for (const ContactPart& part : parts) all.push_back(part.points);
  return all;
}

std::vector<contact::PointTree> ContactParts::pointsOf(const std::vector<int>& touching) const {
  std::vector<contact::PointTree> all(pointSets);
  for (const int part : touching) {
    const int set = parts[static_cast<std::size_t>(part)].points;
    contact::PointTree& tree = all[static_cast<std::size_t>(set)];
    if (tree.nodes().empty()) tree = points(set);
  }
  return all;
}

contact::PartMotion ContactParts::motionOf(std::size_t part, const multibody::State& state) const {
  const ContactPart& p = parts[part];
  const base::Pose pose = multibody::compose(state.pose[p.body], p.pose_B);
  return {pose.position, pose.orientation.matrix(), state.pose[p.body].position, state.twist[p.body].v,
          state.twist[p.body].w};
}

} // namespace grouser::coupling

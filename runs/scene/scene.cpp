// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/scene.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::scene {

SpeedTable Driver::speeds() const {
  if (table) return *table;
  return {{0}, {left.value_or(sprocketSpeed.value_or(0))}, {right.value_or(sprocketSpeed.value_or(0))}};
}

TorqueTable Driver::torques() const {
  if (torqueTable) return *torqueTable;
  return {{0}, {leftTorque.value_or(torque.value_or(0))}, {rightTorque.value_or(torque.value_or(0))}};
}

double GrainFill::smallestRadius() const {
  double least = radius.value_or(1e300);
  for (const Grain& g : fromFile) least = std::min(least, g.radius);
  return least;
}

double GrainFill::largestRadius() const {
  double most = radiusTo.value_or(radius.value_or(0));
  for (const Grain& g : fromFile) most = std::max(most, g.radius);
  return most;
}

const Material& Scene::material(const std::string& name) const {
  for (const Material& m : materials)
    if (m.name == name) return m;
  throw base::InputError(
      fmt::format("{}: the scene has no material \"{}\"; add a section [material.{}]", file.string(), name, name));
}

const ContactPair* Scene::contact(const std::string& a, const std::string& b) const {
  for (const ContactPair& p : contacts)
    if ((p.first == a && p.second == b) || (p.first == b && p.second == a)) return &p;
  return nullptr;
}

} // namespace grouser::scene

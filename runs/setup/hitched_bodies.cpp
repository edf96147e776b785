// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/hitched_bodies.hpp"

#include "runs/scene/scene.hpp"
#include "runs/setup/vehicle_setup.hpp"

#include <fmt/format.h>

namespace grouser::setup {

std::optional<vehicle::Assembly> vehicleOf(const scene::Scene& scene) {
  if (!scene.vehicle || scene.mechanism.empty()) return {};
  return coupling::assembleOnLevelGround(vehicleSetup(scene));
}

std::vector<bool> hitchedBodies(const scene::Scene& scene, const multibody::Model& model,
                                const vehicle::Assembly& vehicle) {
  const multibody::PartCounts first = vehicle.model.counts();
  std::vector<bool> hitched(model.bodies().size());
  hitched[static_cast<std::size_t>(vehicle.chassis)] = true;
  const auto moves = [&](int body) {
    return body != multibody::kWorld && !model.bodies()[static_cast<std::size_t>(body)].fixed;
  };
  const auto is = [&](int body) { return body != multibody::kWorld && hitched[static_cast<std::size_t>(body)]; };
  for (bool grew = true; grew;) {
    grew = false;
    const auto tie = [&](int a, int b) {
      if (is(a) == is(b) || !moves(is(a) ? b : a)) return;
      hitched[static_cast<std::size_t>(is(a) ? b : a)] = grew = true;
    };
    const auto tieAll = [&](const auto& parts, std::size_t from) {
      for (std::size_t i = from; i < parts.size(); ++i) tie(parts[i].bodyA, parts[i].bodyB);
    };
    tieAll(model.joints(), first.joints), tieAll(model.pointSprings(), first.pointSprings);
    tieAll(model.bushings(), first.bushings);
  }
  for (std::size_t j = first.joints; j < model.joints().size(); ++j) {
    const multibody::Joint& joint = model.joints()[j];
    if ((is(joint.bodyA) && !moves(joint.bodyB)) || (is(joint.bodyB) && !moves(joint.bodyA)))
      scene.fail("joint", j - first.joints, "bodies",
                 "connect the vehicle rigidly to the world, which prevents its placement on the ground; use a "
                 "[[spring]] or [[bushing]]");
  }
  return hitched;
}

} // namespace grouser::setup

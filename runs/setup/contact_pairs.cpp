// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/contact_pairs.hpp"

#include "runs/scene/scene.hpp"

#include <fmt/format.h>

namespace grouser::setup {

ContactPairs::ContactPairs(const scene::Scene& scene) : kinds(grainKinds(scene)), surfaces(surfacesOf(scene)) {
  using Kind = ContactPartner::Kind;
  for (const std::string& material : kinds.material) partners.push_back({Kind::grains, material, material});
  const auto& terrain = scene.terrain;
  if (terrain && terrain->granular() && terrain->walls)
    partners.push_back({Kind::bedWalls, terrain->groundMaterial, "a wall of the terrain", 0, terrain->wallFriction});
  std::size_t next = 0; // index of the surface; moving and named planes come first
  const auto addSurface = [&] {
    const SceneSurface& s = surfaces[next];
    partners.push_back({Kind::surface, s.section.material, s.name, next++});
  };
  for (std::size_t k = 0; k < scene.planes.size(); ++k) {
    if (scene.planes[k].isWall())
      partners.push_back({Kind::plane, scene.planes[k].material, "a plane", k});
    else
      addSurface();
  }
  while (next < surfaces.size()) addSurface();
  if (terrain)
    partners.push_back({Kind::floor, terrain->granular() ? terrain->groundMaterial : terrain->material, "the floor"});
  if (scene.vehicle) partners.push_back({Kind::vehicle, scene.vehicle->material, "the vehicle"});
  for (std::size_t b = 0; b < scene.mechanism.bodies.size(); ++b)
    if (const scene::BodySection& body = scene.mechanism.bodies[b]; !body.shapes.empty())
      partners.push_back({Kind::body, body.material, fmt::format("body \"{}\"", body.name), b});
}

bool ContactPairs::isPlane(const ContactPartner& partner) const {
  return partner.kind == ContactPartner::Kind::plane || (partner.kind == ContactPartner::Kind::surface &&
                                                         surfaces[partner.number].kind == coupling::SurfaceKind::plane);
}

} // namespace grouser::setup

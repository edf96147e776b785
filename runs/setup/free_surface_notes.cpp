// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/free_surface_notes.hpp"

#include "base/rounded.hpp"
#include "base/sphere.hpp"
#include "contact/mixing.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/body_mass.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/scene_surfaces.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::setup {

std::vector<std::string> freeSurfaceNotes(const scene::Scene& scene) {
  constexpr double kHeavy = 20; // [grain masses]; the dashpot is then 2.5 % too strong
  const ContactPairs pairs(scene);
  const GrainKinds::Kind* heaviest = nullptr;
  double grain = 0; // mass of the heaviest grain [kg]
  for (const GrainKinds::Kind& kind : pairs.kinds.kinds)
    if (const double mass = base::sphereMass(scene.material(kind.material).density, kind.largest); mass > grain)
      grain = mass, heaviest = &kind;
  std::vector<std::string> notes;
  if (hasComplementarity(scene)) return notes; // complementarity contacts need no dashpots
  const auto look = [&](const std::string& what, const std::string& material, double mass) {
    if (!heaviest || mass >= kHeavy * grain) return;
    const contact::ContactLaw law = pairLaw(scene, heaviest->material, material, grain);
    const double wanted = contact::restitutionOf(law, grain, grain),
                 made = contact::restitutionOf(law, grain, grain * mass / (grain + mass));
    if (wanted - made < 0.005) return;
    notes.push_back(fmt::format(
        "{} has a mass of {:g} kg, and the heaviest grain {:.3g} kg: their impacts have a restitution of {:.3f} "
        "instead of {:.3f}, since damping depends on the grain mass only; use a mass of at least {} kg",
        what, mass, grain, made, wanted, base::roundedUp(kHeavy * grain, 3)));
  };
  for (const SceneSurface& s : pairs.surfaces)
    if (s.free) look(fmt::format("{} \"{}\" is free and", s.list(), s.name), s.section.material, s.free->mass);
  for (const scene::BodySection& body : scene.mechanism.bodies)
    if (!body.shapes.empty() && !body.fixed) look(fmt::format("body \"{}\"", body.name), body.material, massOf(body));
  return notes;
}

std::string movingSurfacesWarning(const scene::Scene& scene) {
  const std::vector<SceneSurface> surfaces = surfacesOf(scene);
  const auto moves = [](const coupling::SurfaceSetup& s) { return s.moves; };
  if (!scene.mechanism.touches() || std::none_of(surfaces.begin(), surfaces.end(), moves)) return "";
  return "bodies pass through planes, boxes, cylinders and meshes that move, which have contact with grains only; use "
         "a driven [[body]] instead";
}

std::string bedWallsNote(const scene::Scene& scene) {
  if (!scene.mechanism.touches() || !scene.terrain || !scene.terrain->granular()) return "";
  return "the walls and the floor of the bed have contact with grains only, so a body that reaches them passes "
         "through; keep bodies inside the bed, or add a fixed [[body]] there";
}

} // namespace grouser::setup

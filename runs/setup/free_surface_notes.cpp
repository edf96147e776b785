// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/free_surface_notes.hpp"

#include "base/rounded.hpp"
#include "base/sphere.hpp"
#include "contact/mixing.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/laws.hpp"

#include <fmt/format.h>

namespace grouser::setup {

std::vector<std::string> freeSurfaceNotes(const scene::Scene& scene) {
  constexpr double kHeavy = 20; // grains; then the dashpot is 2.5 % stronger than asked for
  const ContactPairs pairs(scene);
  const GrainKinds::Kind* heaviest = nullptr;
  double grain = 0; // its mass [kg]
  for (const GrainKinds::Kind& kind : pairs.kinds.kinds)
    if (const double mass = base::sphereMass(scene.material(kind.material).density, kind.largest); mass > grain)
      grain = mass, heaviest = &kind;
  std::vector<std::string> notes;
  for (const SceneSurface& s : pairs.surfaces) {
    if (!s.free || !heaviest || s.free->mass >= kHeavy * grain) continue;
    const contact::ContactLaw law = pairLaw(scene, heaviest->material, s.section.material, grain);
    const double wanted = contact::restitutionOf(law, grain, grain),
                 made = contact::restitutionOf(law, grain, grain * s.free->mass / (grain + s.free->mass));
    if (wanted - made < 0.005) continue;
    notes.push_back(fmt::format("{} \"{}\" is free with a mass of {:g} kg, and the heaviest grain has {:.3g} kg: a "
                                "grain rebounds from it with a restitution of {:.3f} instead of {:.3f}, since damping "
                                "follows from the grain's mass alone; use a mass of at least {} kg",
                                s.list(), s.name, s.free->mass, grain, made, wanted,
                                base::roundedUp(kHeavy * grain, 3)));
  }
  return notes;
}

} // namespace grouser::setup

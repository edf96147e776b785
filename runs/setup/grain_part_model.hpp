// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "runs/scene/scene.hpp"
#include "terrain/grains.hpp"

#include <functional>
#include <optional>
#include <string>

namespace grouser::setup {

/// Constants of the contacts between a scene's grains and parts made of spheres.
struct GrainPartSetup {
  contact::GrainPartModel model;
  contact::GrainPartMaterials materials;
};
/// The law between a grain's material and the parts, for grains of one mass [kg] or (without) of many.
using PartLaw = std::function<contact::ContactLaw(const std::string& soil, std::optional<double> mass)>;
/// `margin`: parts may move so far before pairs are looked for anew [m].
GrainPartSetup grainPartModel(const scene::Scene& scene, const terrain::Grains& grains, double timeStep, double margin,
                              const PartLaw& lawOf);

inline contact::GrainPartContacts::GrainsView viewOf(const terrain::Grains& grains) {
  return {grains.positions(), grains.velocities(), grains.spins(), grains.ids(), grains.slots(), grains.ghosts()};
}

} // namespace grouser::setup

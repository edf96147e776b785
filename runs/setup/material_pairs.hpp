// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Contact parameters of a grain and a partner, from the mixing rule, [contact] and the vehicle file.
struct MaterialPair {
  std::string grain, partner; ///< materials
  ContactPartner::Kind touched{};
  std::string what;             ///< "grain on grain", "grain on the floor", "grain on box drum"
  contact::ContactLaw law;      ///< law of the smallest grains of this material
  double stiffness{};           ///< linear k [N/m]; hertz: effective modulus E_eff [Pa]
  double restitution{};         ///< from law and damping [-]
  double cohesion{};            ///< energy of adhesion [J/m2]
  std::vector<std::string> off; ///< sentences about parameters without effect in this pair
};

/// Each pair once, in the order of the materials in the file; partners with the same material and kind form one pair.
std::vector<MaterialPair> materialPairs(const scene::Scene& scene);

} // namespace grouser::setup

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// A grain and something that it can touch, with what acts between them: after the mixing rule, [contact] and the
/// vehicle's file.
struct MeetingPair {
  std::string grain, partner; ///< materials
  ContactPartner::Kind touched{};
  std::string what;             ///< for the reader: "grain on grain", "grain on the floor", "grain on box drum"
  contact::ContactLaw law;      ///< for the smallest grains of that material
  double stiffness{};           ///< linear k [N/m]; hertz: effective modulus E_eff [Pa]
  double restitution{};         ///< that follows from law and damping [-]
  double cohesion{};            ///< energy of adhesion [J/m2]
  std::vector<std::string> off; ///< what one of the two materials has and the pair has not, each as a sentence
};

/// Each pair once, in the order of the materials in the file; partners of one material and kind in one.
std::vector<MeetingPair> meetingPairs(const scene::Scene& scene);

} // namespace grouser::setup

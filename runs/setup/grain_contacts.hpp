// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// A kind of contact that the smallest or the largest grains of a material can have: with grains of one of the
/// materials, alike otherwise, or with something that does not give way.
struct GrainContact {
  std::string material, other; ///< of the grain, and of what it touches
  std::string name;            ///< "grain on the floor"
  bool amongGrains = false;    ///< gives way as the grain does; else not at all
  contact::ContactLaw law;
  double mass = 0, radius = 0;                   ///< of the grain [kg], [m]
  double effectiveMass = 0, effectiveRadius = 0; ///< of the contact [kg], [m]
  /// As stiff as it gets: of a Hertz contact in an elastic impact at run.impact_speed.
  contact::Coefficients<double> coefficients{};
  /// Stiffness where it matters over that [-]: in the impact itself, which its dashpot makes less deep, or under a heap
  /// as high as wide, whichever is stiffer; 1 of a linear contact.
  double softer = 1;
  double rollingStiffness = 0, rollingDamping = 0; ///< [N m/rad], [N m s/rad]
  double duration = 0;                             ///< of the undamped contact [s]
};
enum class Of { smallest, largest };
/// Of each material's smallest grains, which are the quickest, or of its largest.
std::vector<GrainContact> grainContacts(const scene::Scene& scene, const ContactPairs& pairs, Of which = Of::smallest);

} // namespace grouser::setup

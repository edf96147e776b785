// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// A kind of contact of the smallest or the largest grains of a material: with equal grains of one of the materials, or
/// with a rigid partner.
struct GrainContact {
  std::string material, other; ///< of the grain, and of what it touches
  std::string name;            ///< "grain on the floor"
  bool amongGrains = false;    ///< partner is a grain; otherwise rigid
  contact::ContactLaw law;
  double mass = 0, radius = 0;                   ///< of the grain [kg], [m]
  double effectiveMass = 0, effectiveRadius = 0; ///< of the contact [kg], [m]
  /// Maximum stiffness: for a Hertz contact in an elastic impact at run.impact_speed.
  contact::Coefficients<double> coefficients{};
  /// Relevant stiffness over that [-]: of the damped impact, or under a heap as high as wide, whichever is stiffer; 1
  /// for a linear contact.
  double softer = 1;
  double rollingStiffness = 0, rollingDamping = 0; ///< [N m/rad], [N m s/rad]
  double duration = 0;                             ///< of the undamped contact [s]
};
enum class GrainSize { smallest, largest };
/// Contacts of each material's smallest grains, which are the shortest, or of its largest.
std::vector<GrainContact> grainContacts(const scene::Scene& scene, const ContactPairs& pairs,
                                        GrainSize size = GrainSize::smallest);

} // namespace grouser::setup

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_law.hpp"
#include "runs/setup/contact_pairs.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// A kind of contact of the smallest or the largest grains of a material. The partner is an equal grain of one of the
/// materials, or rigid.
struct GrainContact {
  std::string material, other; ///< materials of the grain and of its partner
  std::string name;            ///< "grain on the floor"
  bool amongGrains = false;    ///< partner is a grain; otherwise rigid
  contact::ContactLaw law;
  double mass = 0, radius = 0;                   ///< grain mass [kg] and radius [m]
  double effectiveMass = 0, effectiveRadius = 0; ///< effective mass [kg] and radius [m] of the contact
  /// Maximum stiffness: for a Hertz contact in an elastic impact at run.impact_speed.
  contact::Coefficients<double> coefficients{};
  /// Relevant stiffness / maximum stiffness [-]: the larger one of a damped impact and of the load under a heap as high
  /// as wide; 1 for a linear contact.
  double softer = 1;
  double rollingStiffness = 0, rollingDamping = 0; ///< [N m/rad], [N m s/rad]
  double duration = 0;                             ///< duration of the undamped contact [s]
};
enum class GrainSize { smallest, largest };
/// Contacts of the smallest grains of each material (shortest duration), or of the largest.
std::vector<GrainContact> grainContacts(const scene::Scene& scene, const ContactPairs& pairs,
                                        GrainSize size = GrainSize::smallest);

} // namespace grouser::setup

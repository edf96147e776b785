// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>

namespace grouser::contact {

/// Contact moment of a grain: the symmetric part of the sum of contact force times lever arm. Summed over the grains of
/// a volume and divided by that volume, it is the mean stress (Love 1927; Weber 1966, Cahiers du Groupe Francais de
/// Rheologie 3:161), positive in tension.
struct ContactMoment {
  double of[6] = {}; ///< xx, xy, xz, yy, yz, zz [N m]
  std::int32_t contacts = 0;

  /// `force` on the grain [N], `arm` from its centre to the contact point [m].
  GROUSER_HD void add(const base::Vec3d& force, const base::Vec3d& arm) {
    int k = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b) of[k++] += 0.5 * (force[a] * arm[b] + force[b] * arm[a]);
    ++contacts;
  }
  GROUSER_HD ContactMoment& operator+=(const ContactMoment& other) {
    for (int k = 0; k < 6; ++k) of[k] += other.of[k];
    contacts += other.contacts;
    return *this;
  }
};

/// Contact moments of grains against parts, as read by the grain kernel. `range` as in GrainLoadsView.
struct PartMomentsView {
  const std::uint32_t* range{nullptr};
  const ContactMoment* moment{nullptr};
};

} // namespace grouser::contact

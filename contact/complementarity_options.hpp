// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace grouser::contact {

enum class ImpulseFriction { coulomb, associated }; ///< see contact/impulse_cone.hpp
enum class Compliance { law, rigid };               ///< springs of the contact law, or no springs

/// Options of complementarity contacts.
struct ComplementarityOptions {
  ImpulseFriction friction{ImpulseFriction::coulomb};
  Compliance compliance{Compliance::law};
  double residual{};   ///< tolerance of a step [m/s], > 0
  int iterations{200}; ///< maximum per step, > 0
  double recovery{};   ///< maximum separation speed of overlapping rigid contacts [m/s], >= 0
  double impact{};     ///< minimum approach speed [m/s] for Newton restitution of a new contact
  /// Maximum gap of a pair at rest that enters the problem [m]; also limited to a fraction of the smallest radius.
  double reach = std::numeric_limits<double>::infinity();
  bool strict{false}; ///< true: exceeding the residual ends the run
  bool operator==(const ComplementarityOptions&) const = default;
};

} // namespace grouser::contact

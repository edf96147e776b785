// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cstdint>
#include <vector>

namespace grouser::contact {

/// Impulse on a body about its centre of mass, world components.
struct BodyImpulse {
  base::Vec3d linear;  ///< [N s]
  base::Vec3d angular; ///< [N m s]
};

/// Velocity of a body's centre of mass and its angular velocity, world components.
struct BodyVelocity {
  base::Vec3d linear;  ///< [m/s]
  base::Vec3d angular; ///< [rad/s]
};

/// Rigid bodies with parts among the grains, within one step in which all contacts are solved for simultaneously: their
/// velocities at its end depend linearly on the impulses of the grains. The same on all ranks.
class BodyResponse {
public:
  /// Of a body without joints; zero where it never moves.
  struct Inverse {
    double mass{};       ///< [1/kg]
    base::Mat3d inertia; ///< world axes [1/(kg m2)]
  };

  virtual ~BodyResponse() = default;
  /// [part] index of its body among `inverses()`.
  virtual const std::vector<std::uint32_t>& bodyOfPart() const = 0;
  /// [body]; they bound the response: joints only make bodies heavier.
  virtual const std::vector<Inverse>& inverses() const = 0;
  /// Velocities at the end of the step under these impulses, one of each a body.
  virtual void respond(const std::vector<BodyImpulse>& impulses, std::vector<BodyVelocity>& velocities) = 0;
};

} // namespace grouser::contact

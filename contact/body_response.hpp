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

/// Velocity response of the rigid bodies in contact with grains, within one step that solves all contacts
/// simultaneously: the end velocities depend linearly on the grain impulses. All ranks have the same values.
class BodyResponse {
public:
  /// Inverse mass properties of a free body; zero for a fixed body.
  struct Inverse {
    double mass{};       ///< [1/kg]
    base::Mat3d inertia; ///< world axes [1/(kg m2)]
  };

  virtual ~BodyResponse() = default;
  /// [part] index of the part's body in `inverses()`.
  virtual const std::vector<std::uint32_t>& bodyOfPart() const = 0;
  /// Inverse mass properties by body. They are an upper bound on the response, which joints can only reduce.
  virtual const std::vector<Inverse>& inverses() const = 0;
  /// Computes the velocities at the end of the step from the impulses, one entry per body.
  virtual void respond(const std::vector<BodyImpulse>& impulses, std::vector<BodyVelocity>& velocities) = 0;
};

} // namespace grouser::contact

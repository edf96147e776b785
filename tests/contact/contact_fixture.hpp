// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/rolling_resistance.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::contact::testing {

/// A linear law with friction.
template <class T> BasicLaw<T> linear() {
  BasicLaw<T> law;
  law.stiffness = T(1e5), law.damping = 800, law.tangentialStiffness = T(3e4), law.tangentialDamping = 400;
  law.friction = T(0.5);
  return law;
}

/// Glass: E = 4.8e10, nu = 0.2.
template <class T> BasicLaw<T> hertz() {
  BasicLaw<T> law;
  const double effective = 4.8e10 / (2 * (1 - 0.2 * 0.2)), shear = 2e10 / (2 * 1.8);
  law.hertz = true;
  law.stiffness = T(4.0 / 3 * effective), law.tangentialStiffness = T(8 * shear);
  law.rootDamping = T(0.2 * std::sqrt(2 * effective)), law.tangentialRootDamping = law.rootDamping / 2;
  law.friction = T(0.5);
  return law;
}

/// One sphere on a fixed plane z = 0, for tests of the pure laws: integrated with the scheme of the grains' step
/// (symplectic Euler), in double.
struct SphereOnPlane {
  BasicLaw<double> law;
  double radius, mass;
  base::Vec3d position{}, velocity{}, spin{}, gravity{};
  base::Vec3d shear{}, angle{};
  double dissipated = 0, deepest = 0, strongest = 0, touched = 0;
  bool touching = false;
  bool fullArm = true; ///< the tangential force acts at R, as in the closed forms; otherwise at R - overlap

  double overlap() const { return radius - position.z; }
  double inertia() const { return 0.4 * mass * radius * radius; }

  void step(double dt) {
    base::Vec3d force = gravity * mass, torque{};
    if (overlap() > 0) {
      if (!touching) shear = angle = {};
      touching = true;
      const base::Vec3d n{0, 0, -1}, arm = n * (fullArm ? radius : radius - overlap());
      const BasicContactGeometry<double> touch{n, overlap(), velocity + cross(spin, arm), mass, radius};
      const auto r = contactForce<kGeneral>(law, touch, dt, shear);
      force += r.force, torque += cross(arm, r.force);
      dissipated += r.damped + r.rubbed + r.slipped;
      if (law.rollingFriction > 0) {
        const RollingMotion<double> rolling{n, spin, radius, 1.4 * mass * radius * radius};
        torque += rollingTorque(law, rolling, r.pressing, r.normalStiffness, dt, angle, dissipated,
                                law.hertz ? &r.change : nullptr);
      }
      deepest = std::max(deepest, overlap()), strongest = std::max(strongest, r.force.z);
      touched += dt;
    } else {
      touching = false;
    }
    velocity += force * (dt / mass);
    spin += torque * (dt / inertia());
    position += velocity * dt;
  }

  double energy() const {
    const double held = touching && overlap() > 0 ? storedEnergy(law, overlap(), radius, shear) : 0;
    return 0.5 * mass * norm2(velocity) + 0.5 * inertia() * norm2(spin) - mass * dot(gravity, position) + held;
  }
};

} // namespace grouser::contact::testing

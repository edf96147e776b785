// SPDX-License-Identifier: BSD-3-Clause
#include "runs/laws.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::runs {

namespace {

/// Damping gamma [1/s] of one material in a contact of natural frequency omega0 [1/s].
double dampingOf(const std::optional<double>& restitution, const std::optional<double>& damping, bool attraction,
                 double omega0) {
  if (damping) return *damping;
  return 2 * omega0 * contact::dampingRatioFor(restitution.value_or(1), attraction);
}

} // namespace

double sphereMass(double density, double radius) {
  return density * (4.0 / 3.0) * base::kPi * radius * radius * radius;
}

contact::ContactLaw pairLaw(const Scene& scene, const std::string& a, const std::string& b, double effectiveMass) {
  const Material &ma = scene.material(a), &mb = scene.material(b);
  const ContactPair* pair = scene.contact(a, b);
  double stiffness = a == b ? ma.stiffness : 2 * ma.stiffness * mb.stiffness / (ma.stiffness + mb.stiffness);
  double friction = std::min(ma.friction, mb.friction);
  if (pair && pair->stiffness) stiffness = *pair->stiffness;
  if (pair && pair->friction) friction = *pair->friction;
  const bool attraction = ma.attraction && mb.attraction;
  const double omega0 = std::sqrt(stiffness / effectiveMass);
  // The smaller restitution is the larger damping.
  double damping = std::max(dampingOf(ma.restitution, ma.damping, attraction, omega0),
                            dampingOf(mb.restitution, mb.damping, attraction, omega0));
  if (pair && (pair->restitution || pair->damping))
    damping = dampingOf(pair->restitution, pair->damping, attraction, omega0);

  contact::ContactLaw law;
  law.stiffness = static_cast<float>(stiffness);
  law.damping = static_cast<float>(damping);
  law.tangentialStiffness =
      static_cast<float>(stiffness * std::min(ma.tangentialStiffnessRatio, mb.tangentialStiffnessRatio));
  law.tangentialDamping = static_cast<float>(damping * std::min(ma.tangentialDampingRatio, mb.tangentialDampingRatio));
  law.friction = static_cast<float>(friction);
  law.attraction = attraction;
  return law;
}

} // namespace grouser::runs

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/laws.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "runs/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace grouser::setup {

namespace {

using contact::ContactLaw;

/// Damping gamma [1/s] of one material in a contact of natural frequency omega0 [1/s].
double dampingOf(const std::optional<double>& restitution, const std::optional<double>& damping, bool attraction,
                 double omega0) {
  if (damping) return *damping;
  return 2 * omega0 * contact::dampingRatioFor(restitution.value_or(1), attraction);
}

void setLinear(const scene::Scene& scene, const scene::Material& a, const scene::Material& b,
               const scene::ContactPair* pair, std::optional<double> effectiveMass, ContactLaw& law) {
  const double ka = *a.stiffness, kb = *b.stiffness;
  double stiffness = &a == &b ? ka : 2 * ka * kb / (ka + kb);
  if (pair && pair->stiffness) stiffness = *pair->stiffness;
  const double ratio = std::min(*a.tangentialStiffnessRatio, *b.tangentialStiffnessRatio);
  const double dampingRatio = std::min(*a.tangentialDampingRatio, *b.tangentialDampingRatio);
  law.stiffness = stiffness, law.tangentialStiffness = stiffness * ratio;
  const bool given = pair && (pair->restitution || pair->damping);
  if (effectiveMass) {
    const auto dampingAt = [&](double mass) {
      const double omega0 = std::sqrt(stiffness / mass);
      // The smaller restitution is the larger damping.
      return given ? dampingOf(pair->restitution, pair->damping, law.attraction, omega0)
                   : std::max(dampingOf(a.restitution, a.damping, law.attraction, omega0),
                              dampingOf(b.restitution, b.damping, law.attraction, omega0));
    };
    law.damping = dampingAt(*effectiveMass);
    law.tangentialDamping = law.damping * dampingRatio;
    // Against a fixed grain the other's whole mass moves, twice that of two free ones.
    if (law.damping > 0) law.fixedShare = dampingAt(2 * *effectiveMass) / law.damping;
    return;
  }
  if (!given && a.damping.has_value() != b.damping.has_value())
    scene.failMaterial(
        (a.damping ? a : b).name, "damping",
        fmt::format("[1/s] cannot be compared with the restitution of material.{} among grains of many masses; give "
                    "both the same way, or [contact.\"{}|{}\"] for the pair",
                    (a.damping ? b : a).name, a.name, b.name));
  const std::optional<double> damping = given       ? pair->damping
                                        : a.damping ? std::optional(std::max(*a.damping, *b.damping))
                                                    : std::nullopt;
  if (damping) {
    law.damping = *damping, law.tangentialDamping = *damping * dampingRatio;
    return;
  }
  const double restitution = given ? *pair->restitution : std::min(*a.restitution, *b.restitution);
  law.rootDamping = 2 * contact::dampingRatioFor(restitution, law.attraction) * std::sqrt(stiffness);
  law.tangentialRootDamping = law.rootDamping * dampingRatio;
}

double shearModulus(const scene::Material& m) { return *m.young / (2 * (1 + *m.poisson)); }

void setHertz(const scene::Material& a, const scene::Material& b, const scene::ContactPair* pair, ContactLaw& law) {
  const auto compliance = [](const scene::Material& m) { return (1 - *m.poisson * *m.poisson) / *m.young; };
  const auto shearCompliance = [](const scene::Material& m) { return (2 - *m.poisson) / shearModulus(m); };
  const double modulus = 1 / (compliance(a) + compliance(b));
  law.hertz = true;
  law.stiffness = 4.0 / 3 * modulus;
  law.tangentialStiffness = 8 / (shearCompliance(a) + shearCompliance(b));
  const double restitution = pair && pair->restitution ? *pair->restitution : std::min(*a.restitution, *b.restitution);
  const double beta = contact::hertzDampingRatioFor(restitution, law.attraction);
  law.rootDamping = 2 * beta * std::sqrt(2 * modulus);
  law.tangentialRootDamping =
      2 * beta * std::min(*a.tangentialDampingRatio, *b.tangentialDampingRatio) * std::sqrt(law.tangentialStiffness);
}

/// Radius of equal grains that the energies of adhesion of a pair are meant for, if they grow with it.
std::optional<double> adhesionRadius(const scene::Material& a, const scene::Material& b) {
  if (!a.adhesionRadius || &a == &b) return a.adhesionRadius ? a.adhesionRadius : b.adhesionRadius;
  return b.adhesionRadius ? std::sqrt(*a.adhesionRadius * *b.adhesionRadius) : *a.adhesionRadius;
}

/// The smaller plasticity and adhesion stiffness, the geometric mean of the surface energies, the larger exponent and
/// plastic depth.
contact::BasicPlasticity<double> plasticityOf(const scene::Material& a, const scene::Material& b,
                                              const scene::ContactPair* pair, const ContactLaw& law) {
  contact::BasicPlasticity<double> p;
  p.share = pair && pair->plasticity ? *pair->plasticity : std::min(*a.plasticity, *b.plasticity);
  if (p.share <= 0) return {};
  if (a.law == scene::ContactLawKind::luding) {
    // x* = k2 / (k2 - k1) phi_f 2 R_i R_j / (R_i + R_j) (Luding 2008)
    p.fullDepth = 2 * std::max(*a.plasticDepth, *b.plasticDepth) / p.share;
    p.adhesion = std::min(*a.adhesionStiffness, *b.adhesionStiffness) / law.stiffness;
    return p;
  }
  const double exponent = law.hertz ? 1.5 : 1;
  p.depthShare = law.hertz ? base::pow(p.share, 1 / exponent) : p.share;
  p.lossShare = p.share / (1 - p.share) * (1 - p.depthShare) * exponent / (exponent + 1);
  const double energy = pair && pair->surfaceEnergy ? *pair->surfaceEnergy
                        : &a == &b                  ? *a.surfaceEnergy
                                                    : std::sqrt(*a.surfaceEnergy * *b.surfaceEnergy);
  const double pull = 1.5 * base::kPi * energy * std::sqrt(2 * p.depthShare);
  if (const std::optional<double> radius = adhesionRadius(a, b))
    p.pullGrowth = pull / (0.5 * *radius);
  else
    p.pull = pull;
  p.exponent = static_cast<int>(2 * std::max(*a.adhesionExponent, *b.adhesionExponent));
  return p;
}

} // namespace

ContactLaw pairLaw(const scene::Scene& scene, const std::string& nameA, const std::string& nameB,
                   std::optional<double> effectiveMass) {
  const scene::Material &a = scene.material(nameA), &b = scene.material(nameB);
  const scene::ContactPair* pair = scene.contact(nameA, nameB);
  if (a.hertzian() != b.hertzian() || (a.yields() && b.yields() && a.law != b.law))
    scene.failMaterial(b.name, "law",
                       fmt::format("does not go with law = \"{}\" of material.{}, which it meets: surfaces that touch "
                                   "must both be hertz or eepa, or both linear, eepa_linear or luding, and no "
                                   "eepa_linear meets luding; give both one of the two",
                                   base::wordOf(a.law), a.name));
  ContactLaw law;
  law.attraction = a.attraction && b.attraction;
  law.friction = pair && pair->friction ? *pair->friction : std::min(a.friction, b.friction);
  law.rollingFriction =
      pair && pair->rollingFriction ? *pair->rollingFriction : std::min(a.rollingFriction, b.rollingFriction);
  law.rollingDamping = std::min(a.rollingDampingRatio, b.rollingDampingRatio);
  const double cohesion = pair && pair->cohesion ? *pair->cohesion
                          : &a == &b             ? a.cohesion
                                                 : std::sqrt(a.cohesion * b.cohesion);
  if (const std::optional<double> radius = adhesionRadius(a, b))
    law.pullPerArea = 2 * base::kPi * cohesion / (0.5 * *radius);
  else
    law.pullPerRadius = 2 * base::kPi * cohesion;
  if (a.hertzian())
    setHertz(a, b, pair, law);
  else
    setLinear(scene, a, b, pair, effectiveMass, law);
  if (a.yields() && b.yields()) law.plastic = plasticityOf(a, b, pair, law);
  return law;
}

contact::Coefficients<double> stiffest(const ContactLaw& law, double effectiveMass, double effectiveRadius,
                                       double speed) {
  const double overlap =
      law.hertz ? contact::hertzImpact(0.75 * law.stiffness, effectiveRadius, effectiveMass, speed).deepest : 0;
  auto c = contact::coefficientsOf<contact::kGeneral>(law, overlap, effectiveMass, effectiveRadius);
  c.normalStiffness /= 1 - law.plastic.share; // of the line along which it is unloaded
  return c;
}

double contactTime(const ContactLaw& law, double effectiveMass, double effectiveRadius, double speed) {
  const double quicker = std::sqrt(1 - law.plastic.share); // on the line along which it is unloaded
  if (!law.hertz) return quicker * base::kPi * std::sqrt(effectiveMass / law.stiffness);
  return quicker * contact::hertzImpact(0.75 * law.stiffness, effectiveRadius, effectiveMass, speed).duration;
}

double restitutionOf(const ContactLaw& law, double effectiveMass, double movedMass) {
  const double more = std::sqrt(effectiveMass / movedMass); // damping over that which is critical for the moved mass
  if (law.hertz)
    return contact::hertzRestitutionOf(more * law.rootDamping / (2 * std::sqrt(1.5 * law.stiffness)), law.attraction);
  const double zeta = law.rootDamping > 0 ? law.rootDamping / (2 * std::sqrt(law.stiffness))
                                          : law.damping / (2 * std::sqrt(law.stiffness / effectiveMass));
  return contact::restitutionOf(more * zeta, law.attraction);
}

double rayleighTimeOf(const scene::Material& m, double radius) {
  if (!m.hertzian()) return std::numeric_limits<double>::infinity();
  return contact::rayleighTime(radius, m.density, shearModulus(m), *m.poisson);
}

} // namespace grouser::setup

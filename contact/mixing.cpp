// SPDX-License-Identifier: BSD-3-Clause
#include "contact/mixing.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::contact {

namespace {

/// Two complete materials with the overrides of their pair.
struct MixedPair {
  MaterialProperties a, b;
  const PairProperties& pair;
  bool same; ///< one material with itself

  double geometricMean(double x, double y) const { return same ? x : std::sqrt(x * y); }
};

/// Damping gamma [1/s] of one material in a contact of natural frequency omega0 [1/s].
double dampingOf(const std::optional<double>& restitution, const std::optional<double>& damping, bool attraction,
                 double omega0) {
  if (damping) return *damping;
  return 2 * omega0 * dampingRatioFor(restitution.value_or(1), attraction);
}

void setLinear(const MixedPair& m, std::optional<double> effectiveMass, ContactLaw& law) {
  const auto& [a, b, pair, same] = m;
  const double ka = *a.stiffness, kb = *b.stiffness;
  const double stiffness = pair.stiffness.value_or(same ? ka : 2 * ka * kb / (ka + kb));
  const double dampingRatio = std::min(*a.tangentialDampingRatio, *b.tangentialDampingRatio);
  law.stiffness = stiffness;
  law.tangentialStiffness = stiffness * std::min(*a.tangentialStiffnessRatio, *b.tangentialStiffnessRatio);
  const bool given = pair.restitution || pair.damping;
  if (effectiveMass) {
    const auto dampingAt = [&](double mass) {
      const double omega0 = std::sqrt(stiffness / mass);
      // Smaller restitution implies larger damping.
      return given ? dampingOf(m.pair.restitution, m.pair.damping, law.attraction, omega0)
                   : std::max(dampingOf(m.a.restitution, m.a.damping, law.attraction, omega0),
                              dampingOf(m.b.restitution, m.b.damping, law.attraction, omega0));
    };
    law.damping = dampingAt(*effectiveMass);
    law.tangentialDamping = law.damping * dampingRatio;
    // Against a fixed grain the full mass of the other one moves, twice the effective mass of two free grains.
    if (law.damping > 0) law.fixedShare = dampingAt(2 * *effectiveMass) / law.damping;
    return;
  }
  if (!given && a.damping.has_value() != b.damping.has_value())
    throw MixingError(MixingError::Reason::dampingBesideRestitution, b.damping.has_value(), "damping",
                      "damping [1/s] of one material cannot be combined with the restitution of the other for grains "
                      "of different masses; set the same key in both materials, or one for the pair");
  const std::optional<double> damping = given       ? pair.damping
                                        : a.damping ? std::optional(std::max(*a.damping, *b.damping))
                                                    : std::nullopt;
  if (damping) {
    law.damping = *damping, law.tangentialDamping = *damping * dampingRatio;
    return;
  }
  const double restitution = given ? *pair.restitution : std::min(*a.restitution, *b.restitution);
  law.rootDamping = 2 * dampingRatioFor(restitution, law.attraction) * std::sqrt(stiffness);
  law.tangentialRootDamping = law.rootDamping * dampingRatio;
}

/// Rebound speed / impact speed [-]. If only damping [1/s] is given: the value for a single mass; 0 for many masses.
double restitutionOfPair(const MixedPair& m, const ContactLaw& law, std::optional<double> effectiveMass) {
  const auto& [a, b, pair, same] = m;
  if (pair.restitution) return *pair.restitution;
  if (a.hertzian() || !(pair.damping || a.damping || b.damping)) return std::min(*a.restitution, *b.restitution);
  return effectiveMass ? restitutionOf(law, *effectiveMass, *effectiveMass) : 0.0;
}

double shearModulus(const MaterialProperties& m) {
  return *m.young / (2 * (1 + m.poisson.value_or(MaterialProperties::kPoisson)));
}

void setHertz(const MixedPair& m, ContactLaw& law) {
  const auto compliance = [](const MaterialProperties& x) { return (1 - *x.poisson * *x.poisson) / *x.young; };
  const auto shearCompliance = [](const MaterialProperties& x) { return (2 - *x.poisson) / shearModulus(x); };
  const double modulus = 1 / (compliance(m.a) + compliance(m.b));
  law.hertz = true;
  law.stiffness = 4.0 / 3 * modulus;
  law.tangentialStiffness = 8 / (shearCompliance(m.a) + shearCompliance(m.b));
  const double restitution = m.pair.restitution.value_or(std::min(*m.a.restitution, *m.b.restitution));
  const double beta = hertzDampingRatioFor(restitution, law.attraction);
  law.rootDamping = 2 * beta * std::sqrt(2 * modulus);
  law.tangentialRootDamping = 2 * beta * std::min(*m.a.tangentialDampingRatio, *m.b.tangentialDampingRatio) *
                              std::sqrt(law.tangentialStiffness);
}

/// Grain radius to which a pair's adhesion energies refer, if these are proportional to the radius.
std::optional<double> adhesionRadius(const MixedPair& m) {
  const std::optional<double>&a = m.a.adhesionRadius, &b = m.b.adhesionRadius;
  return a && b ? m.geometricMean(*a, *b) : a ? a : b;
}

BasicPlasticity<double> plasticityOf(const MixedPair& m, const ContactLaw& law) {
  const auto& [a, b, pair, same] = m;
  BasicPlasticity<double> p;
  p.share = pair.plasticity.value_or(std::min(*a.plasticity, *b.plasticity));
  if (p.share <= 0) return {};
  if (a.law == LawKind::luding) {
    // x* = k2 / (k2 - k1) phi_f 2 R_i R_j / (R_i + R_j) (Luding 2008)
    p.fullDepth = 2 * std::max(*a.plasticDepth, *b.plasticDepth) / p.share;
    p.adhesion = std::min(*a.adhesionStiffness, *b.adhesionStiffness) / law.stiffness;
    return p;
  }
  const double exponent = law.hertz ? 1.5 : 1;
  p.depthShare = law.hertz ? base::pow(p.share, 1 / exponent) : p.share;
  p.lossShare = p.share / (1 - p.share) * (1 - p.depthShare) * exponent / (exponent + 1);
  const double energy = pair.surfaceEnergy.value_or(m.geometricMean(*a.surfaceEnergy, *b.surfaceEnergy));
  const double pull = 1.5 * base::kPi * energy * std::sqrt(2 * p.depthShare);
  if (const std::optional<double> radius = adhesionRadius(m))
    p.pullGrowth = pull / (0.5 * *radius);
  else
    p.pull = pull;
  p.exponent = static_cast<int>(2 * std::max(*a.adhesionExponent, *b.adhesionExponent));
  return p;
}

/// Throws if the two laws are incompatible.
void checkLaws(const MaterialProperties& a, const MaterialProperties& b) {
  if (a.hertzian() != b.hertzian() || (a.yields() && b.yields() && a.law != b.law))
    throw MixingError(MixingError::Reason::lawsDiffer, true, "law",
                      "incompatible contact laws: both materials must be hertz or eepa, or both linear, eepa_linear or "
                      "luding (not eepa_linear with luding); change law of one of them");
  for (const MaterialProperties* m : {&a, &b})
    if (m->hertzian() && !m->young)
      throw MixingError(MixingError::Reason::youngMissing, m == &b, "young",
                        "young [Pa] of a hertz or eepa material is missing; set it, e.g. 7e7");
}

} // namespace

void MaterialProperties::complete() {
  const auto supply = [](std::optional<double>& value, double other) { value = value.value_or(other); };
  if (yields()) supply(plasticity, kPlasticity);
  if (law == LawKind::luding) supply(plasticDepth, kPlasticDepth), supply(adhesionStiffness, 0);
  if (yields() && law != LawKind::luding) supply(surfaceEnergy, 0), supply(adhesionExponent, hertzian() ? 1.5 : 1);
  if (hertzian() || !damping) supply(restitution, kRestitution);
  supply(tangentialDampingRatio, hertzian() ? kHertzTangentialDampingRatio : kLinearTangentialDampingRatio);
  if (hertzian())
    supply(poisson, kPoisson);
  else
    supply(stiffness, kStiffness), supply(tangentialStiffnessRatio, kTangentialStiffnessRatio);
}

ContactLaw mixedLaw(const MaterialProperties& a, const MaterialProperties& b, const PairProperties& pair,
                    std::optional<double> effectiveMass) {
  checkLaws(a, b);
  MixedPair m{a, b, pair, &a == &b};
  m.a.complete(), m.b.complete();
  ContactLaw law;
  law.attraction = a.attraction && b.attraction;
  law.friction = pair.friction.value_or(std::min(a.friction, b.friction));
  law.rollingFriction = pair.rollingFriction.value_or(std::min(a.rollingFriction, b.rollingFriction));
  law.rollingDamping = std::min(a.rollingDampingRatio, b.rollingDampingRatio);
  const double cohesion = pair.cohesion.value_or(m.geometricMean(a.cohesion, b.cohesion));
  if (const std::optional<double> radius = adhesionRadius(m))
    law.pullPerArea = 2 * base::kPi * cohesion / (0.5 * *radius);
  else
    law.pullPerRadius = 2 * base::kPi * cohesion;
  if (a.hertzian())
    setHertz(m, law);
  else
    setLinear(m, effectiveMass, law);
  law.restitution = restitutionOfPair(m, law, effectiveMass);
  if (a.yields() && b.yields()) law.plastic = plasticityOf(m, law);
  return law;
}

Foundation mixedFoundation(const MaterialProperties& a, const MaterialProperties& b, const PairProperties& pair) {
  constexpr double kRatio = MaterialProperties::kTangentialStiffnessRatio;
  constexpr double kRestitution = MaterialProperties::kRestitution;
  const double ka = a.foundationModulus, kb = b.foundationModulus;
  return {
      2 * ka * kb / (ka + kb), pair.friction.value_or(std::min(a.friction, b.friction)),
      pair.restitution.value_or(std::min(a.restitution.value_or(kRestitution), b.restitution.value_or(kRestitution))),
      std::min(a.tangentialStiffnessRatio.value_or(kRatio), b.tangentialStiffnessRatio.value_or(kRatio))};
}

Coefficients<double> stiffest(const ContactLaw& law, double effectiveMass, double effectiveRadius, double speed) {
  const double overlap =
      law.hertz ? hertzImpact(0.75 * law.stiffness, effectiveRadius, effectiveMass, speed).deepest : 0;
  auto c = coefficientsOf<kGeneral>(law, overlap, effectiveMass, effectiveRadius);
  c.normalStiffness /= 1 - law.plastic.share; // stiffness of the unloading line
  return c;
}

double contactTime(const ContactLaw& law, double effectiveMass, double effectiveRadius, double speed) {
  const double quicker = std::sqrt(1 - law.plastic.share); // factor for the unloading line
  if (!law.hertz) return quicker * base::kPi * std::sqrt(effectiveMass / law.stiffness);
  return quicker * hertzImpact(0.75 * law.stiffness, effectiveRadius, effectiveMass, speed).duration;
}

double restitutionOf(const ContactLaw& law, double effectiveMass, double movedMass) {
  const double more = std::sqrt(effectiveMass / movedMass); // damping ratio for the moved mass / for the effective mass
  if (law.hertz)
    return hertzRestitutionOf(more * law.rootDamping / (2 * std::sqrt(1.5 * law.stiffness)), law.attraction);
  const double zeta = law.rootDamping > 0 ? law.rootDamping / (2 * std::sqrt(law.stiffness))
                                          : law.damping / (2 * std::sqrt(law.stiffness / effectiveMass));
  return restitutionOf(more * zeta, law.attraction);
}

double rayleighTimeOf(const MaterialProperties& m, double radius) {
  if (!m.hertzian()) return std::numeric_limits<double>::infinity();
  return rayleighTime(radius, m.density, shearModulus(m), m.poisson.value_or(MaterialProperties::kPoisson));
}

} // namespace grouser::contact

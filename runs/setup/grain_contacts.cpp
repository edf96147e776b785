// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_contacts.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "contact/mixing.hpp"
#include "contact/restitution.hpp"
#include "contact/rolling_resistance.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/laws.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::setup {

namespace {

std::string nameOf(const ContactPairs& pairs, const std::string& grain, const ContactPartner& p) {
  if (p.kind == ContactPartner::Kind::grains)
    return p.material == grain ? "grain on grain of '" + grain + "'"
                               : "grain of '" + grain + "' on grain of '" + p.material + "'";
  return pairs.isPlane(p) ? "grain on a plane of '" + p.material + "'" : "grain on " + p.name;
}

/// Maximum overlap of a Hertz contact in an elastic impact [m].
double depthOf(const GrainContact& c, double speed) {
  return contact::hertzImpact(0.75 * c.law.stiffness, c.effectiveRadius, c.effectiveMass, speed).deepest;
}
/// Overlap under a force [N]: F = stiffness sqrt(R) overlap^(3/2).
double depthUnder(double force, const GrainContact& c) {
  return base::pow(force / (c.law.stiffness * std::sqrt(c.effectiveRadius)), 2.0 / 3);
}
/// Maximum overlap with dashpot / without dashpot [-]: c_n = 2 beta sqrt(k_n m), k_n = (3/2) stiffness a.
double depthShare(const contact::ContactLaw& law) {
  return contact::hertzDepthShare(0.5 * law.rootDamping / std::sqrt(1.5 * law.stiffness));
}

} // namespace

std::vector<GrainContact> grainContacts(const scene::Scene& scene, const ContactPairs& pairs, GrainSize size) {
  std::vector<GrainContact> contacts;
  const double speed = scene.run.impactSpeed;
  // Load on the lowest grains of a heap as high as wide / grain mass [N/kg]; twice the mean, because of force chains.
  const bool hertz = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const scene::Material& m) { return m.hertzian(); });
  const double heap =
      hertz ? base::pow(static_cast<double>(std::max<std::int64_t>(1, plannedGrains(scene))), 1.0 / 3) : 1;
  const double weighing = 2 * heap * norm(scene.run.gravity);
  for (const GrainKinds::Kind& kind : pairs.kinds.kinds) {
    const std::string& material = kind.material;
    const double radius = size == GrainSize::smallest ? kind.smallest : kind.largest;
    const double mass = base::sphereMass(scene.material(material).density, radius);
    for (const ContactPartner& p : pairs.partners) {
      if (p.kind == ContactPartner::Kind::bedWalls) continue; // as stiff as the floor
      const std::string &other = p.materialAgainst(material), name = nameOf(pairs, material, p);
      const bool amongGrains = p.kind == ContactPartner::Kind::grains;
      // The same contact as with an earlier partner, under another name.
      const auto same = std::find_if(contacts.begin(), contacts.end(), [&](const GrainContact& c) {
        return c.material == material && c.other == other && c.amongGrains == amongGrains;
      });
      if (same != contacts.end()) {
        GrainContact again = *same;
        again.name = name;
        contacts.push_back(std::move(again));
        continue;
      }
      GrainContact c;
      c.material = material, c.other = other, c.name = name, c.amongGrains = amongGrains;
      c.mass = mass, c.radius = radius, c.effectiveMass = p.share() * mass, c.effectiveRadius = p.share() * radius;
      c.law = pairLaw(scene, material, other, c.effectiveMass);
      c.coefficients = contact::stiffest(c.law, c.effectiveMass, c.effectiveRadius, speed);
      if (c.law.hertz)
        c.softer = std::sqrt(std::max(depthShare(c.law), depthUnder(weighing * mass, c) / depthOf(c, speed)));
      c.rollingStiffness = contact::rollingStiffness(c.law, c.coefficients.normalStiffness, c.effectiveRadius);
      const double inertia = 1.4 * c.effectiveMass * radius * radius;
      c.rollingDamping = 2 * c.law.rollingDamping * std::sqrt(inertia * c.rollingStiffness);
      c.duration = contact::contactTime(c.law, c.effectiveMass, c.effectiveRadius, speed);
      contacts.push_back(c);
    }
  }
  return contacts;
}

} // namespace grouser::setup

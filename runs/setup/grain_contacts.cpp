// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/grain_contacts.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "contact/restitution.hpp"
#include "contact/rolling_resistance.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/scene_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::setup {

namespace {

/// What a grain can touch.
struct Partner {
  std::string material;
  bool isGrain;
  std::string name;
};

std::vector<Partner> partnersOf(const scene::Scene& scene, const GrainKinds& kinds, const std::string& material) {
  std::vector<Partner> partners;
  for (const std::string& other : kinds.material)
    partners.push_back({other, true,
                        other == material ? "grain on grain of '" + material + "'"
                                          : "grain of '" + material + "' among those of '" + other + "'"});
  const auto against = [&](const std::string& other, const std::string& name) {
    partners.push_back({other.empty() ? material : other, false, name});
  };
  for (const scene::Plane& plane : scene.planes)
    against(plane.material, "grain on a plane of '" + plane.material + "'");
  for (const SceneSurface& s : surfacesOf(scene)) against(s.section.material, "grain on " + s.name);
  if (scene.terrain) against(scene.terrain->groundMaterial, "grain on the floor");
  if (scene.vehicle) against(scene.vehicle->material, "grain on the vehicle");
  return partners;
}

/// Of a Hertz contact in an elastic impact [m].
double depthOf(const GrainContact& c, double speed) {
  return contact::hertzImpact(0.75 * c.law.stiffness, c.effectiveRadius, c.effectiveMass, speed).deepest;
}
/// The same under a force [N]: F = stiffness sqrt(R) overlap^(3/2).
double depthUnder(double force, const GrainContact& c) {
  return base::pow(force / (c.law.stiffness * std::sqrt(c.effectiveRadius)), 2.0 / 3);
}
/// How much less deep an impact is with its dashpot c_n = 2 beta sqrt(k_n m), k_n = (3/2) stiffness a [-].
double depthShare(const contact::ContactLaw& law) {
  return contact::hertzDepthShare(0.5 * law.rootDamping / std::sqrt(1.5 * law.stiffness));
}

} // namespace

std::vector<GrainContact> grainContacts(const scene::Scene& scene, Of which) {
  std::vector<GrainContact> contacts;
  const GrainKinds kinds = grainKinds(scene);
  const double speed = scene.run.impactSpeed;
  // What lies on the lowest grains of a heap that is as high as wide, over their mass [N/kg]; chains bear twice as
  // much.
  const bool hertz = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const scene::Material& m) { return m.hertzian(); });
  const double heap =
      hertz ? base::pow(static_cast<double>(std::max<std::int64_t>(1, plannedGrains(scene))), 1.0 / 3) : 1;
  const double weighing = 2 * heap * norm(scene.run.gravity);
  for (const GrainKinds::Kind& kind : kinds.kinds) {
    const std::string& material = kind.material;
    const double radius = which == Of::smallest ? kind.smallest : kind.largest;
    const double mass = base::sphereMass(scene.material(material).density, radius);
    for (const Partner& p : partnersOf(scene, kinds, material)) {
      // The same as against a former partner, under another name.
      const auto same = std::find_if(contacts.begin(), contacts.end(), [&](const GrainContact& c) {
        return c.material == material && c.other == p.material && c.amongGrains == p.isGrain;
      });
      if (same != contacts.end()) {
        GrainContact again = *same;
        again.name = p.name;
        contacts.push_back(std::move(again));
        continue;
      }
      // Share of its own mass or radius that counts between the two.
      const double share = p.isGrain ? 0.5 : 1;
      GrainContact c;
      c.material = material, c.other = p.material, c.name = p.name, c.amongGrains = p.isGrain;
      c.mass = mass, c.radius = radius, c.effectiveMass = share * mass, c.effectiveRadius = share * radius;
      c.law = pairLaw(scene, material, p.material, c.effectiveMass);
      c.coefficients = stiffest(c.law, c.effectiveMass, c.effectiveRadius, speed);
      if (c.law.hertz)
        c.softer = std::sqrt(std::max(depthShare(c.law), depthUnder(weighing * mass, c) / depthOf(c, speed)));
      c.rollingStiffness = contact::rollingStiffness(c.law, c.coefficients.normalStiffness, c.effectiveRadius);
      const double inertia = 1.4 * c.effectiveMass * radius * radius;
      c.rollingDamping = 2 * c.law.rollingDamping * std::sqrt(inertia * c.rollingStiffness);
      c.duration = contactTime(c.law, c.effectiveMass, c.effectiveRadius, speed);
      contacts.push_back(c);
    }
  }
  return contacts;
}

} // namespace grouser::setup

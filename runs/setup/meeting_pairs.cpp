// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/meeting_pairs.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/vehicle_surface.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <utility>

namespace grouser::setup {

namespace {

/// Where only one of the two has something, the mixing rule makes nothing of it.
std::vector<std::string> switchedOff(const scene::Material& a, const scene::Material& b,
                                     const contact::ContactLaw& law) {
  std::vector<std::string> sentences;
  const auto say = [&](const char* key, const char* rule, double ofA, double ofB, double acts) {
    if (acts > 0 || (ofA > 0) == (ofB > 0)) return;
    const scene::Material &has = ofA > 0 ? a : b, &lacks = ofA > 0 ? b : a;
    sentences.push_back(fmt::format("{} = {:g} of material.{} does nothing against {}, which has 0: {} acts; give "
                                    "material.{} one too, or set it in [contact.\"{}|{}\"]",
                                    key, std::max(ofA, ofB), has.name, lacks.name, rule, lacks.name, a.name, b.name));
  };
  say("friction", "the smaller", a.friction, b.friction, law.friction);
  say("rolling_friction", "the smaller", a.rollingFriction, b.rollingFriction, law.rollingFriction);
  say("cohesion", "the geometric mean", a.cohesion, b.cohesion, law.coheres() ? 1 : 0);
  return sentences;
}

class Pairs {
public:
  explicit Pairs(const scene::Scene& scene) : scene_(scene), kinds_(grainKinds(scene)) {}

  /// All grains against `partner`; an empty name: against their own material.
  void add(Touched touched, const std::string& what, const std::string& partner,
           const std::optional<VehicleSurface>& surface = {}) {
    for (const GrainKinds::Kind& kind : kinds_.kinds)
      addOne(kind, partner.empty() ? kind.material : partner, touched, what, surface);
  }
  void addGrains() {
    for (std::size_t a = 0; a < kinds_.kinds.size(); ++a)
      for (std::size_t b = a; b < kinds_.kinds.size(); ++b)
        addOne(kinds_.kinds[a], kinds_.kinds[b].material, Touched::grain, "grain on grain", {});
  }
  std::vector<MeetingPair> take() { return std::move(pairs_); }

private:
  void addOne(const GrainKinds::Kind& kind, const std::string& partner, Touched touched, const std::string& what,
              const std::optional<VehicleSurface>& surface) {
    if (!seen_.insert({kind.material, partner, what}).second) return;
    const double share = touched == Touched::grain ? 0.5 : 1; // effective mass and radius over the grain's
    const double mass = share * base::sphereMass(scene_.material(kind.material).density, kind.smallest);
    MeetingPair pair{kind.material, partner, touched, what, pairLaw(scene_, kind.material, partner, mass), 0, 0, 0, {}};
    if (surface) pair.law = surface->with(pair.law);
    pair.stiffness = pair.law.hertz ? 0.75 * pair.law.stiffness : pair.law.stiffness;
    pair.restitution = restitutionOf(pair.law, mass, mass);
    const double effectiveRadius = share * kind.smallest;
    pair.cohesion = pair.law.pull(effectiveRadius) / (2 * base::kPi * effectiveRadius);
    pair.off = switchedOff(scene_.material(kind.material), scene_.material(partner), pair.law);
    pairs_.push_back(std::move(pair));
  }

  const scene::Scene& scene_;
  GrainKinds kinds_;
  std::set<std::vector<std::string>> seen_;
  std::vector<MeetingPair> pairs_;
};

} // namespace

std::vector<MeetingPair> meetingPairs(const scene::Scene& scene) {
  Pairs pairs(scene);
  pairs.addGrains();
  if (scene.terrain)
    pairs.add(Touched::ground, scene.terrain->granular() ? "grain on the floor" : "grain on rigid ground",
              scene.terrain->groundMaterial);
  std::set<std::size_t> named;
  for (const SceneSurface& s : surfacesOf(scene)) {
    if (s.geometry.shape == terrain::SurfaceShape::plane && !s.mesh) named.insert(s.number);
    pairs.add(Touched::surface, "grain on " + s.name, s.section.material);
  }
  for (std::size_t k = 0; k < scene.planes.size(); ++k)
    if (!named.contains(k)) pairs.add(Touched::surface, "grain on a plane", scene.planes[k].material);
  if (scene.vehicle)
    pairs.add(Touched::vehicle, "grain on the vehicle", scene.vehicle->material, vehicleSurface(scene));
  return pairs.take();
}

} // namespace grouser::setup

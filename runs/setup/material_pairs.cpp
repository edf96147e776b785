// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/material_pairs.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "contact/mixing.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/vehicle_surface.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <utility>

namespace grouser::setup {

namespace {

/// Sentences about parameters of one material that have no effect, since the mixing rule sets them to 0.
std::vector<std::string> switchedOff(const scene::Material& a, const scene::Material& b,
                                     const contact::ContactLaw& law) {
  std::vector<std::string> sentences;
  const auto say = [&](const char* key, const char* rule, double ofA, double ofB, double acts) {
    if (acts > 0 || (ofA > 0) == (ofB > 0)) return;
    const scene::Material &has = ofA > 0 ? a : b, &lacks = ofA > 0 ? b : a;
    sentences.push_back(fmt::format("{} = {:g} of material.{} has no effect in contact with {}, which has 0 (mixing "
                                    "rule: {}); set it for material.{} too, or in [contact.\"{}|{}\"]",
                                    key, std::max(ofA, ofB), has.name, lacks.name, rule, lacks.name, a.name, b.name));
  };
  say("friction", "minimum", a.friction, b.friction, law.friction);
  say("rolling_friction", "minimum", a.rollingFriction, b.rollingFriction, law.rollingFriction);
  say("cohesion", "geometric mean", a.cohesion, b.cohesion, law.coheres() ? 1 : 0);
  return sentences;
}

/// Pairs of a grain kind and a partner material; one per combination of names.
class MeetingPairs {
public:
  explicit MeetingPairs(const scene::Scene& scene) : scene_(scene) {}

  void add(const GrainKinds::Kind& kind, const std::string& partner, ContactPartner::Kind touched,
           const std::string& what, double share, const std::optional<VehicleSurface>& surface = {}) {
    if (!seen_.insert({kind.material, partner, what}).second) return;
    const double mass = share * base::sphereMass(scene_.material(kind.material).density, kind.smallest);
    MaterialPair pair{
        kind.material, partner, touched, what, pairLaw(scene_, kind.material, partner, mass), 0, 0, 0, {}};
    if (surface) pair.law = surface->with(pair.law);
    pair.stiffness = pair.law.hertz ? 0.75 * pair.law.stiffness : pair.law.stiffness;
    pair.restitution = contact::restitutionOf(pair.law, mass, mass);
    const double effectiveRadius = share * kind.smallest;
    pair.cohesion = pair.law.pull(effectiveRadius) / (2 * base::kPi * effectiveRadius);
    pair.off = switchedOff(scene_.material(kind.material), scene_.material(partner), pair.law);
    pairs_.push_back(std::move(pair));
  }
  std::vector<MaterialPair> take() { return std::move(pairs_); }

private:
  const scene::Scene& scene_;
  std::set<std::vector<std::string>> seen_;
  std::vector<MaterialPair> pairs_;
};

} // namespace

std::vector<MaterialPair> materialPairs(const scene::Scene& scene) {
  using Kind = ContactPartner::Kind;
  const ContactPairs all(scene);
  const std::vector<GrainKinds::Kind>& kinds = all.kinds.kinds;
  MeetingPairs pairs(scene);
  for (std::size_t a = 0; a < kinds.size(); ++a)
    for (std::size_t b = a; b < kinds.size(); ++b)
      pairs.add(kinds[a], kinds[b].material, Kind::grains, "grain on grain", 0.5);
  const std::optional<VehicleSurface> ofVehicle = vehicleSurface(scene);
  for (const Kind shown : {Kind::floor, Kind::surface, Kind::plane, Kind::vehicle, Kind::body})
    for (const ContactPartner& p : all.partners) {
      if (p.kind != shown) continue;
      const bool rigid = p.kind == Kind::floor && !scene.terrain->granular();
      for (const GrainKinds::Kind& kind : kinds)
        pairs.add(kind, p.materialAgainst(kind.material), p.kind,
                  rigid ? "grain on rigid ground" : "grain on " + p.name, p.share(),
                  p.kind == Kind::vehicle ? ofVehicle : std::nullopt);
    }
  return pairs.take();
}

} // namespace grouser::setup

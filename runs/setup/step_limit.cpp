// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/step_limit.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "base/sphere.hpp"
#include "base/table.hpp"
#include "contact/restitution.hpp"
#include "contact/rolling_resistance.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/time_scales.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace grouser::setup {

using base::Vec3d;

namespace {

/// The longest step that run.time_step takes [s].
constexpr double kLongestStep = 0.1;

/// Keeps the smaller limit: of the mode x'' + damping x' + stiffness x = 0 [1/s, 1/s2].
void consider(StepLimit& limit, double stiffness, double damping, const std::string& what,
              const std::string& remedy = "lower its stiffness") {
  if (stiffness <= 0 && damping <= 0) return;
  const double step = contact::stableStepOfMode(stiffness, damping);
  if (step < limit.step) limit = {step, what, remedy};
}

/// What a grain can touch.
struct Partner {
  std::string material;
  bool isGrain; ///< gives way as the grain does; else not at all
  std::string name;

  /// Share of the grain's own mass or radius that counts between the two [-].
  double share() const { return isGrain ? 0.5 : 1; }
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

/// A grain of `mass` and `radius` among twelve neighbours alike, or between two heavy bodies. A Hertz contact is as
/// stiff as an impact at `speed` makes it.
void considerGrain(StepLimit& limit, const contact::ContactLaw& law, double mass, double radius, const Partner& partner,
                   double speed) {
  const bool among = partner.isGrain;
  const double effectiveMass = partner.share() * mass, effectiveRadius = partner.share() * radius;
  const auto c = stiffest(law, effectiveMass, effectiveRadius, speed);
  // Among twelve, 8 k / m (Gershgorin). Springs that stick let spheres turn alike at 10/3 k_t / m for each contact:
  // eight of those, for a bed with friction has four or five. Hertz contacts are not all as deep at once as the one
  // of that impact: four. Between two bodies: 2 k / m and 5 k_t / m.
  const double normal = (among ? 8 : 2) / mass, turning = (!among ? 5 : 10.0 / 3 * (law.hertz ? 4 : 8)) / mass;
  consider(limit, normal * c.normalStiffness, normal * c.damping, partner.name);
  if (law.friction > 0) consider(limit, turning * c.tangentialStiffness, turning * c.tangentialDamping, partner.name);
  // Rolling springs act on angles: as the normal ones, with the moment of inertia for the mass.
  const double rolling = contact::rollingStiffness(law, c.normalStiffness, effectiveRadius);
  const double rollingInertia = 1.4 * effectiveMass * radius * radius, inertia = 0.4 * mass * radius * radius;
  const double rollingDamping = 2 * law.rollingDamping * std::sqrt(rollingInertia * rolling);
  consider(limit, normal * mass / inertia * rolling, normal * mass / inertia * rollingDamping, partner.name);
}

/// How many grains may lie on a surface at once: a dense layer on its largest face, all of them on a plane.
double mostTouching(const scene::Scene& scene, const SceneSurface& surface, double radius) {
  const Vec3d& h = surface.geometry.half;
  double area = 4 * std::max({h.x * h.y, h.x * h.z, h.y * h.z});
  const auto all = static_cast<double>(std::max<std::int64_t>(1, plannedGrains(scene)));
  if (surface.geometry.shape == terrain::SurfaceShape::plane) return all;
  if (surface.geometry.shape != terrain::SurfaceShape::box) area = 4 * h.x * std::max(h.x, h.z);
  return std::clamp(area / (2 * std::sqrt(3.0) * radius * radius), 1.0, all);
}

/// A surface that forces move, on springs of all grains that it may touch.
void considerFreeSurfaces(StepLimit& limit, const scene::Scene& scene, const GrainKinds& kinds) {
  for (const SceneSurface& s : surfacesOf(scene)) {
    if (!s.section.free) continue;
    for (const auto& [material, radius, largest] : kinds.kinds) {
      const double mass = base::sphereMass(scene.material(material).density, radius);
      const auto c = stiffest(pairLaw(scene, material, s.section.material, mass), mass, radius, scene.run.impactSpeed);
      const double springs = mostTouching(scene, s, radius) / *s.section.mass;
      consider(
          limit, c.normalStiffness * (1 / mass + springs), c.damping * (1 / mass + springs),
          fmt::format("{} of {:g} kg on up to {:.0f} grains", s.name, *s.section.mass, mostTouching(scene, s, radius)),
          fmt::format("raise {}.{}.mass", s.list(), s.number));
    }
  }
}

/// The foundation between parts: shoes on rigid ground, and wheels on shoes.
void considerVehicle(StepLimit& limit, const vehicle::VehicleSpec& s) {
  const vehicle::ContactSpec& c = s.contact;
  // A shoe that lies on its whole pad: the stiffest that the foundation can be.
  const double pad = c.foundationModulus * 4 * s.shoe.halfLength * s.shoe.padHalfWidth / s.shoe.mass;
  consider(limit, pad, pad * c.relaxationTime, "shoe on rigid ground or wheel",
           "lower contact.foundation_modulus in vehicle.spec");
  // A wheel that lies in the plate by a millimetre, far more than the weight presses it in.
  constexpr double kDeep = 1e-3; // [m]
  const auto wheel = [&](const char* name, double mass, double radius) {
    const double area = 4 * s.shoe.padHalfWidth * std::sqrt(2 * radius * kDeep);
    const double stiffness = c.foundationModulus * area * (1 / mass + 1 / s.shoe.mass);
    consider(limit, stiffness, stiffness * c.relaxationTime, fmt::format("{} of {:g} kg on shoes", name, mass),
             "raise its mass or lower contact.foundation_modulus in vehicle.spec");
  };
  wheel("road wheel", s.roadWheel.mass, s.roadWheel.radius);
  wheel("idler", s.idler.mass, s.idler.radius);
  if (!s.roller.x.empty()) wheel("roller", s.roller.mass, s.roller.radius);
}

} // namespace

StepLimit stepLimit(const scene::Scene& scene) {
  StepLimit limit;
  const GrainKinds kinds = grainKinds(scene);
  // The smallest grains are the quickest.
  for (const auto& [material, radius, largest] : kinds.kinds) {
    const double mass = base::sphereMass(scene.material(material).density, radius);
    for (const Partner& p : partnersOf(scene, kinds, material))
      considerGrain(limit, pairLaw(scene, material, p.material, p.share() * mass), mass, radius, p,
                    scene.run.impactSpeed);
  }
  considerFreeSurfaces(limit, scene, kinds);
  if (scene.vehicle) considerVehicle(limit, vehicle::readVehicleSpec(scene.vehicle->spec));
  return limit;
}

double shortestContact(const scene::Scene& scene) {
  double shortest = std::numeric_limits<double>::infinity();
  const GrainKinds kinds = grainKinds(scene);
  for (const auto& [material, radius, largest] : kinds.kinds) {
    const double mass = base::sphereMass(scene.material(material).density, radius);
    for (const Partner& p : partnersOf(scene, kinds, material))
      shortest = std::min(shortest, contactTime(pairLaw(scene, material, p.material, p.share() * mass),
                                                p.share() * mass, p.share() * radius, scene.run.impactSpeed));
  }
  return std::isfinite(shortest) ? shortest : 0;
}

namespace {

/// How far a grain sinks under its own weight [m]: linear F = k overlap, hertz F = K sqrt(R) overlap^(3/2).
double sinksBy(const contact::ContactLaw& law, double weight, double effectiveRadius) {
  if (!law.hertz) return weight / law.stiffness;
  return base::pow(weight / (law.stiffness * std::sqrt(effectiveRadius)), 2.0 / 3);
}

/// Throws at the key that says how stiff two materials are against each other; `times`: how much more it would have to
/// be.
[[noreturn]] void failStiffness(const scene::Scene& scene, const scene::Material& a, const scene::Material& b,
                                double times, const std::string& message) {
  const auto wanted = [&](double stiffness) {
    return fmt::format("{}; raise it to {} at least, or choose smaller grains", message,
                       base::roundedUp(times * stiffness, 3));
  };
  if (a.law == scene::ContactLawKind::hertz) {
    const scene::Material& soft = *b.young < *a.young ? b : a;
    scene.failMaterial(soft.name, "young", "[Pa] " + wanted(*soft.young));
  }
  const scene::ContactPair* pair = scene.contact(a.name, b.name);
  if (pair && pair->stiffness && scene.document)
    for (const auto& [name, section] : scene.document->root().named("contact"))
      if (name == pair->first + "|" + pair->second) section.fail("stiffness", "[N/m] " + wanted(*pair->stiffness));
  const scene::Material& soft = *b.stiffness < *a.stiffness ? b : a;
  scene.failMaterial(soft.name, "stiffness", "[N/m] " + wanted(*soft.stiffness));
}

/// Throws where a grain at rest sinks deeper than a run may bear: contacts so soft hold nothing up, last longer than
/// runs do, and their energies have no scale in common with those of gravity.
void checkSoftness(const scene::Scene& scene) {
  const double gravity = norm(scene.run.gravity), most = scene.run.maxOverlap;
  if (gravity == 0) return;
  const GrainKinds kinds = grainKinds(scene);
  for (const auto& [name, smallest, radius] : kinds.kinds) {
    const double mass = base::sphereMass(scene.material(name).density, radius);
    for (const Partner& p : partnersOf(scene, kinds, name)) {
      const contact::ContactLaw law = pairLaw(scene, name, p.material, p.share() * mass);
      const double sinks = sinksBy(law, mass * gravity, p.share() * radius) / radius;
      if (sinks <= most) continue;
      // A hundredth more than what is needed, so that the number holds as it is printed.
      const double times = 1.01 * (law.hertz ? std::sqrt(sinks / most) : 1) * sinks / most;
      failStiffness(
          scene, scene.material(name), scene.material(p.material), times,
          fmt::format("is so soft that a grain of radius {:g} m sinks in by {:.3g} radii under its own weight "
                      "({}); run.max_overlap allows {:g}",
                      radius, sinks, p.name, most));
    }
  }
}

} // namespace

double chooseTimeStep(const scene::Scene& scene) {
  if (!scene.mechanism.empty()) return mechanismTimeStep(scene);
  checkSoftness(scene);
  const StepLimit limit = stepLimit(scene);
  const double contact = shortestContact(scene);
  double automatic = std::min(contact > 0 ? contact / kStepsPerContact : kVehicleTimeStep, 0.5 * limit.step);
  for (const auto& [material, radius, largest] : grainKinds(scene).kinds)
    automatic = std::min(automatic, kRayleighShare * rayleighTimeOf(scene.material(material), radius));
  automatic = std::min(automatic, resolvingStep(timeScales(scene), scene.run.stepsPerPeriod));
  // What may be given is what is chosen: soft contacts ask for no more.
  automatic = std::min({automatic, kLongestStep, scene.run.duration});
  if (!scene.run.timeStep) return automatic;
  checkTimeScales(scene, *scene.run.timeStep);
  const bool hertz = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const scene::Material& m) { return m.law == scene::ContactLawKind::hertz; });
  if (*scene.run.timeStep > limit.step) {
    const std::string most = base::roundedDown(limit.step, 3);
    scene.fail("run", "time_step",
               fmt::format("[s] is above {} s, where the stiffest contact of the scene ({}) becomes unstable; choose "
                           "{} s or less (\"auto\": {} s), or {}{}",
                           most, limit.what, most, base::roundedDown(automatic, 3), limit.remedy,
                           hertz ? fmt::format("; hertz contacts are taken at run.impact_speed = {:g} m/s",
                                               scene.run.impactSpeed)
                                 : ""));
  }
  return *scene.run.timeStep;
}

namespace {

/// What is said to be allowed is a round number where its factors are.
constexpr double kRounding = 1 + 1e-12;

/// How far a point of a surface can be from what it turns about, but for the part of it that turning brings upon itself
/// [m]. A plane has no end: what is far out there does not count.
double leverOf(const SceneSurface& s) {
  const Vec3d& h = s.geometry.half;
  const Vec3d turning = base::normalized(*s.section.spin);
  const double arm = s.section.pivot ? norm(cross(turning, s.start.position - *s.section.pivot)) : 0;
  switch (s.geometry.shape) {
  case terrain::SurfaceShape::plane:
    return 0;
  case terrain::SurfaceShape::box:
    return arm + norm(h);
  default: {
    const Vec3d axis = rotate(s.start.orientation, {0, 0, 1});
    return arm + norm(cross(turning, axis)) * norm(h);
  }
  }
}

void checkSurfaceSpeeds(const scene::Scene& scene, double smallest, double timeStep) {
  const double most = kRounding * 0.5 * smallest / timeStep;
  for (const SceneSurface& s : surfacesOf(scene)) {
    // A plane is felt by its motion along its normal alone: a belt may be as quick as it likes.
    const bool plane = s.geometry.shape == terrain::SurfaceShape::plane;
    const auto across = [&](const std::optional<Vec3d>& v) {
      return !v ? 0.0 : plane ? std::fabs(dot(*v, base::normalized(scene.planes[s.number].normal))) : norm(*v);
    };
    const double shifts =
        across(s.section.velocity) + across(s.section.amplitude) * 2 * base::kPi * s.section.frequency.value_or(0);
    const double turns = s.section.spin && norm(*s.section.spin) > 0 ? norm(*s.section.spin) * leverOf(s) : 0;
    if (shifts + turns > most)
      scene.fail(s.list(), s.number,
                 turns > shifts       ? "spin"
                 : s.section.velocity ? "velocity"
                                      : "amplitude",
                 fmt::format("moves {} at up to {:.4g} m/s, more than half the smallest grain's radius in a step of "
                             "{:.3g} s: it could pass through a grain unfelt; keep it below {} m/s (velocity, spin, "
                             "amplitude, frequency), or lower run.time_step",
                             s.name, shifts + turns, timeStep, base::roundedDown(most, 4)));
  }
}

} // namespace

void checkSpeeds(const scene::Scene& scene, double timeStep) {
  const GrainKinds kinds = grainKinds(scene);
  if (!kinds.any()) return;
  checkSurfaceSpeeds(scene, kinds.smallest, timeStep);
  const double most = kRounding * 0.5 * scene.run.skin * kinds.smallest / timeStep;
  const auto check = [&](const char* list, const auto& sections) {
    for (std::size_t k = 0; k < sections.size(); ++k)
      if (norm(sections[k].velocity) > most)
        scene.fail(list, k, "velocity",
                   fmt::format("[m/s] is more than half the neighbour list's skin in a step of {:.3g} s; keep it below "
                               "{} m/s, or lower run.time_step, or raise run.skin",
                               timeStep, base::roundedDown(most, 4)));
  };
  check("grain", scene.grains), check("grains", scene.fills), check("source", scene.sources);
}

} // namespace grouser::setup

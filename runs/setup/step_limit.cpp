// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/step_limit.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "base/sphere.hpp"
#include "base/table.hpp"
#include "contact/mixing.hpp"
#include "contact/restitution.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/fluid_setup.hpp"
#include "runs/setup/grain_contacts.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/scm_setup.hpp"
#include "runs/setup/step_modes.hpp"
#include "runs/setup/time_scales.hpp"
#include "runs/setup/vehicle_step_limit.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <vector>

namespace grouser::setup {

using base::Vec3d;

namespace {

/// The maximum of run.time_step [s].
constexpr double kLongestOfAll = 0.1;

/// Coefficient of rolling friction up to which the limit of the rolling torque alone bounds the energy that rolling
/// springs and dashpots can create; in packed beds, coefficients from 0.3 on create more than other contacts dissipate.
constexpr double kBoundedRolling = 0.2;

/// Eigenvalue of rolling contacts / rolling coefficient of one contact [1/(kg m2)]. Rolling springs act on angles: as
/// normal springs, with the moment of inertia instead of the mass. Of twelve contacts with normals in all directions,
/// each resists two thirds of the rotations; neighbours that turn the other way double this, but not all can: 8.
/// Between two fixed bodies: 2.
double rollingModes(const GrainContact& c) { return (c.amongGrains ? 8 : 2) / (0.4 * c.mass * c.radius * c.radius); }

/// Limit up to which no contact creates energy.
///
/// Springs: twelve neighbours together count as 8 k / m (Gershgorin). The step of an impact is at most half its own
/// limit, since an impact that ends between two steps may otherwise gain energy. Its springs thus count four times: two
/// grains (2 k / m) as 8 k / m; their slip (7 k_t / m) as 28 k_t / m, with the coupling of both 30, for Hertz 25.
///
/// Dashpots: forces f in contacts with closing speeds a change the kinetic energy per step by f^T G f dt^2 / 2 - f a dt
/// with G = B^T M^-1 B. Repulsive forces (f >= 0) on a grain satisfy (sum f n)^2 <= 2.25 sum f^2, if the unit normals n
/// are at least 60 degrees apart (maximum: one and five around it). A contact acts on two grains: 4.5 c / m. Dashpots
/// that also pull form modes: 5.9 c / m in random beds (`grouser study stability`), 6.5 here, 8 in a crystal. Friction
/// adds the smaller of its own dashpot and Coulomb's limit, (mu f)^2: 10 / 3 m per contact of spheres that rotate in
/// the same sense, for three sticking contacts at a time. Rolling resistance adds the same.
void considerEnergy(StepLimit& limit, const GrainContact& c) {
  const double share = c.amongGrains ? 1 : 0.5, inertia = 0.4 * c.mass * c.radius * c.radius;
  const double k = c.coefficients.normalStiffness, d = c.coefficients.damping;
  const double arm = c.law.rollingFriction * c.effectiveRadius;
  double springs = std::max((c.amongGrains ? 8 : 4) * k / c.mass, share * 2 * c.rollingStiffness / inertia);
  double dashpots = (!c.amongGrains ? 2 : c.law.attraction ? 6.5 : 4.5) * d / c.mass;
  if (c.law.friction > 0) {
    springs = std::max(springs, share * (c.law.hertz ? 25 : 30) * c.coefficients.tangentialStiffness / c.mass);
    dashpots += share * 10 * std::min(c.coefficients.tangentialDamping, c.law.friction * c.law.friction * d) / c.mass;
  }
  dashpots += share * 10 * std::min(c.rollingDamping, arm * arm * d) / inertia;
  // Springs of a Hertz contact are proportional to overlap^(1/2), dashpots to overlap^(1/4).
  consider(limit, c.softer * springs, std::sqrt(c.softer) * dashpots, c.name);
  if (c.law.rollingFriction <= kBoundedRolling) return;
  const double rolling = rollingModes(c);
  consider(limit, c.softer * rolling * c.rollingStiffness, std::sqrt(c.softer) * rolling * c.rollingDamping, c.name,
           "lower its rolling_friction or rolling_damping_ratio");
}

/// Limit up to which all modes of non-sliding contacts decay.
void considerModes(StepLimit& limit, const GrainContact& c) {
  // Spheres that stick to each other rotate in the same sense, with 10/3 k_t / m per contact. Eight contacts are
  // assumed; grains of a bed with friction have four or five. For Hertz four, since not all contacts are as deep at
  // once as in the impact of run.impact_speed. Between two fixed bodies: 2 k / m and 5 k_t / m.
  const bool among = c.amongGrains;
  const double normal = (among ? 8 : 2) / c.mass;
  const double turning = (!among ? 5 : 10.0 / 3 * (c.law.hertz ? 4 : 8)) / c.mass;
  considerCalm(limit, normal * c.coefficients.normalStiffness, normal * c.coefficients.damping);
  if (c.law.friction > 0)
    considerCalm(limit, turning * c.coefficients.tangentialStiffness, turning * c.coefficients.tangentialDamping);
  const double rolling = rollingModes(c);
  considerCalm(limit, rolling * c.rollingStiffness, rolling * c.rollingDamping);
}

/// Maximum number of grains on a surface: a dense layer on its largest face or on `face` [m2]; on a plane, all grains.
double maxTouching(const scene::Scene& scene, const contact::SurfaceGeometry& g, double radius, double face = 0) {
  const Vec3d h = g.shape == contact::SurfaceShape::plane ? Vec3d{} : halfExtent(g);
  double area = 4 * std::max({h.x * h.y, h.x * h.z, h.y * h.z});
  const auto all = static_cast<double>(std::max<std::int64_t>(1, plannedGrains(scene)));
  if (g.shape == contact::SurfaceShape::plane) return all;
  if (g.shape != contact::SurfaceShape::box) area = 4 * h.x * std::max(h.x, h.z);
  return std::clamp(std::max(area, face) / (2 * std::sqrt(3.0) * radius * radius), 1.0, all);
}

/// Limit for free surfaces on the contact springs of all grains that can touch them.
void considerFreeSurfaces(StepLimit& limit, const scene::Scene& scene, const ContactPairs& pairs) {
  for (const SceneSurface& s : pairs.surfaces) {
    if (!s.section.free) continue;
    for (const auto& [material, radius, largest] : pairs.kinds.kinds) {
      const double mass = base::sphereMass(scene.material(material).density, radius);
      const contact::ContactLaw law = pairLaw(scene, material, s.section.material, mass);
      const auto c = contact::stiffest(law, mass, radius, scene.run.impactSpeed);
      const double springs = 1 / mass + maxTouching(scene, s.geometry, radius) / *s.section.mass;
      considerBoth(limit, c.normalStiffness * springs, c.damping * springs,
                   fmt::format("{} of {:g} kg on up to {:.0f} grains", s.name, *s.section.mass,
                               maxTouching(scene, s.geometry, radius)),
                   fmt::format("raise {}.{}.mass", s.list(), s.number));
    }
  }
}

/// Lower bound of the smallest principal moment of inertia [kg m2].
double minInertia(const base::Mat3d& inertia) {
  const auto& I = inertia.m;
  if (I[0][1] == 0 && I[0][2] == 0 && I[1][2] == 0) return std::min({I[0][0], I[1][1], I[2][2]});
  const double trace = I[0][0] + I[1][1] + I[2][2];
  const double determinant = I[0][0] * (I[1][1] * I[2][2] - I[1][2] * I[1][2]) -
                             I[0][1] * (I[0][1] * I[2][2] - I[1][2] * I[0][2]) +
                             I[0][2] * (I[0][1] * I[1][2] - I[1][1] * I[0][2]);
  return 4 * determinant / (trace * trace); // the product of the two larger moments is at most trace^2 / 4
}

/// Limit for a body on the springs of all grains that its shapes can touch at once: a dense layer on both sides of the
/// largest face of each shape, at the distance of the grain centres. Springs all over a face contribute sum k / m to
/// translation and sum k r^2 / I to rotation, with a mean r^2 of a third of the largest.
void considerBodies(StepLimit& limit, const scene::Scene& scene, const ContactPairs& pairs,
                    const coupling::MechanismSetup& mechanism) {
  for (std::size_t b = 0; b < scene.mechanism.bodies.size(); ++b) {
    const std::size_t index = mechanism.ofVehicle.bodies + b;
    const multibody::Body& body = mechanism.model.bodies()[index];
    if (body.fixed) continue;
    const double inertia = minInertia(body.inertia_B);
    for (const auto& [material, radius, largest] : pairs.kinds.kinds) {
      double touching = 0, turning = 0;
      for (const coupling::BodyShape& s : mechanism.shapes) {
        if (s.body != index) continue;
        const Vec3d reach = halfExtent(s.shape) + Vec3d{radius, radius, radius};
        const double most =
            2 * maxTouching(scene, {contact::SurfaceShape::box, reach}, radius, s.mesh ? 0.5 * s.mesh->facingArea : 0);
        touching += most;
        turning += most * (norm2(s.pose_B.position) + norm2(reach) / 3) / inertia;
      }
      if (touching == 0) continue;
      const double mass = base::sphereMass(scene.material(material).density, radius);
      const contact::ContactLaw law = pairLaw(scene, material, scene.mechanism.bodies[b].material, mass);
      const auto c = contact::stiffest(law, mass, radius, scene.run.impactSpeed);
      const double springs = 1 / mass + touching / body.mass + turning;
      considerBoth(limit, c.normalStiffness * springs, c.damping * springs,
                   fmt::format("body \"{}\" of {:g} kg on up to {:.0f} grains", body.name, body.mass, touching),
                   fmt::format("raise body.{}.mass or its inertia", b));
    }
  }
}

/// [body] Factor on the springs of contacts, since the other side may move too: 1 if all partners are fixed; 2 if
/// partners belong to one group of jointed bodies; 4 for two or more groups (Gershgorin).
std::vector<double> sidesPressed(const coupling::MechanismSetup& mechanism, const coupling::ContactParts& parts) {
  const std::vector<multibody::Body>& bodies = mechanism.model.bodies();
  std::vector<std::size_t> group(bodies.size()); // [body] smallest index among the bodies that joints connect to it
  for (std::size_t b = 0; b < bodies.size(); ++b) group[b] = b;
  for (const multibody::Joint& j : mechanism.model.joints()) {
    if (j.bodyA == multibody::kWorld || j.bodyB == multibody::kWorld) continue;
    const std::size_t a = group[static_cast<std::size_t>(j.bodyA)], b = group[static_cast<std::size_t>(j.bodyB)];
    for (std::size_t& g : group)
      if (g == a || g == b) g = std::min(a, b);
  }
  std::vector<std::set<std::size_t>> partners(bodies.size());
  for (const coupling::ContactParts::Pair& pair : parts.pairs) {
    const auto bodyOf = [&](int part) { return mechanism.shapes[static_cast<std::size_t>(part)].body; };
    const std::size_t a = bodyOf(pair.part), b = bodyOf(pair.other);
    if (!bodies[a].fixed && !bodies[b].fixed) partners[a].insert(group[b]), partners[b].insert(group[a]);
  }
  std::vector<double> sides;
  for (const std::set<std::size_t>& p : partners) sides.push_back(p.empty() ? 1 : p.size() == 1 ? 2 : 4);
  return sides;
}

/// Limit for a body on the Winkler foundation K under one of its shapes, with the area A of the largest face, or of an
/// overlap of kDeep radii if the shape is round: K A / m for translation, K A r^2 / I for rotation.
void considerFoundations(StepLimit& limit, const scene::Scene& scene, const coupling::MechanismSetup& mechanism) {
  constexpr double kDeep = 0.01; // [radius]
  // Soil damping stops a body within a few decay times. Its heat has a relative error of half a step per decay time.
  constexpr double kSettling = 6; // [decay times]
  coupling::ContactParts parts;
  coupling::addBodyParts(parts, mechanism, mechanism.model);
  const bool meetsRigid = mechanism.foundations.ground >= 0 || scene.vehicle || !obstaclesOf(scene).empty();
  if (!meetsRigid && parts.pairs.empty()) return;
  const std::vector<multibody::Body>& bodies = mechanism.model.bodies();
  const std::vector<double> sides = sidesPressed(mechanism, parts);
  const std::optional<coupling::ScmSetup> soil = scmSetup(scene);
  std::vector<double> springs(bodies.size()), dampers(bodies.size()), bounces(bodies.size()); // [1/s2], [1/s], [1/s2]
  for (const coupling::BodyShape& s : mechanism.shapes) {
    const multibody::Body& body = bodies[s.body];
    if (body.fixed) continue;
    const Vec3d half = halfExtent(s.shape);
    const double area = coupling::largestPatch(s.shape, kDeep * s.shape.half.x);
    const double arm2 = norm2(s.pose_B.position) + norm2(half) / 3;
    double rate = 0, decay = 0;
    for (std::size_t other = 0; other < mechanism.foundations.materials.size(); ++other) {
      const contact::Foundation& f = mechanism.foundations.between(s.material, static_cast<int>(other));
      const bool onSoil = soil && static_cast<int>(other) == mechanism.foundations.ground;
      const double modulus = onSoil ? soil->stiffest(2 * std::min({half.x, half.y, half.z})) : f.modulus;
      double stiffness = modulus * area * (1 / body.mass + arm2 / minInertia(body.inertia_B));
      // Strong dashpots need steps that resolve their decay, so that low restitutions are accurate within 2 %.
      constexpr double kResolved = 0.6;
      const double zeta = contact::dampingRatioFor(f.restitution, false);
      const double quicker = onSoil ? 1 : std::max(1.0, zeta / kResolved);
      bounces[s.body] = std::max(bounces[s.body], sides[s.body] * stiffness * quicker * quicker);
      // Velocities decay to exp(-2 zeta omega dt) in a step, which is stable for omega^2 dt^2 < 2 (1 + exp(-4 zeta)).
      if (onSoil)
        decay = std::max(decay, stiffness * soil->soil.damping / modulus);
      else
        stiffness *= 2 / (1 + base::exp(-4 * zeta));
      rate = std::max(rate, stiffness);
    }
    springs[s.body] = std::max(springs[s.body], sides[s.body] * rate);
    dampers[s.body] = std::max(dampers[s.body], sides[s.body] * decay);
  }
  for (std::size_t b = mechanism.ofVehicle.bodies; b < bodies.size(); ++b) {
    const std::size_t section = b - mechanism.ofVehicle.bodies;
    if (bounces[b] > 0) limit.bounce = std::min(limit.bounce, base::kPi / std::sqrt(bounces[b]));
    if (dampers[b] > 0) limit.bounce = std::min(limit.bounce, kSettling / dampers[b]);
    considerBoth(limit, springs[b], dampers[b],
                 fmt::format("body \"{}\" of {:g} kg on rigid surfaces or bodies", bodies[b].name, bodies[b].mass),
                 fmt::format("raise body.{}.mass, or lower foundation_modulus of material.{}", section,
                             scene.mechanism.bodies[section].material));
  }
}

void considerGrains(StepLimit& limit, const scene::Scene& scene, const std::vector<GrainContact>& contacts) {
  const bool alone = !scene.terrain && plannedGrains(scene) == 1;
  for (const GrainContact& c : contacts) {
    if (!alone || !c.amongGrains) considerEnergy(limit, c);
    considerModes(limit, c);
  }
}

/// With complementarity contacts, only contacts between parts have springs.
StepLimit stepLimit(const scene::Scene& scene, const ContactPairs& pairs, const std::vector<GrainContact>& contacts) {
  StepLimit limit;
  const bool springs = !hasComplementarity(scene);
  if (springs) considerGrains(limit, scene, contacts), considerFreeSurfaces(limit, scene, pairs);
  if (scene.mechanism.touches()) {
    const coupling::MechanismSetup mechanism = mechanismSetup(scene);
    if (springs) considerBodies(limit, scene, pairs, mechanism);
    considerFoundations(limit, scene, mechanism);
  }
  limit.vehicle.clear();
  if (!scene.vehicle) return limit;
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  considerVehicle(limit, scene, spec);
  return limit;
}

double shortestOf(const std::vector<GrainContact>& contacts) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const GrainContact& c : contacts) shortest = std::min(shortest, c.duration);
  return std::isfinite(shortest) ? shortest : 0;
}

/// Overlap of a grain under its own weight [m]: linear F = k overlap, hertz F = K sqrt(R) overlap^(3/2).
double overlapUnderWeight(const contact::ContactLaw& law, double weight, double effectiveRadius) {
  if (!law.hertz) return weight / law.stiffness;
  return base::pow(weight / (law.stiffness * std::sqrt(effectiveRadius)), 2.0 / 3);
}

/// Throws InputError at the key of the stiffness between two materials; `times`: factor by which to raise it.
[[noreturn]] void failStiffness(const scene::Scene& scene, const scene::Material& a, const scene::Material& b,
                                double times, const std::string& message) {
  const auto wanted = [&](double stiffness) {
    return fmt::format("{}; raise it to {} or more, or use smaller grains", message,
                       base::roundedUp(times * stiffness, 3));
  };
  if (a.hertzian()) {
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

/// Throws InputError if the overlap of a grain at rest exceeds run.max_overlap.
void checkSoftness(const scene::Scene& scene, const ContactPairs& pairs) {
  const double gravity = norm(scene.run.gravity), most = scene.run.entryOverlap();
  if (gravity == 0) return;
  for (const GrainContact& c : grainContacts(scene, pairs, GrainSize::largest)) {
    const double sinks = overlapUnderWeight(c.law, c.mass * gravity, c.effectiveRadius) / c.radius;
    if (sinks <= most) continue;
    // One percent more than required, so that the rounded number in the message suffices.
    const double times = 1.01 * (c.law.hertz ? std::sqrt(sinks / most) : 1) * sinks / most;
    failStiffness(scene, scene.material(c.material), scene.material(c.other), times,
                  fmt::format("is too low: the weight of a grain of radius {:g} m causes an overlap of {:.3g} radii "
                              "({}), but run.max_overlap allows {:g}",
                              c.radius, sinks, c.name, most));
  }
}

/// Twice the limits of "auto", i.e. half the step at which the lattice of particles becomes unstable.
void checkFluidStep(const scene::Scene& scene) {
  const fluid::StepLimits limits = fluidStepLimits(scene);
  if (!(*scene.run.timeStep > 2 * limits.least())) return;
  const char* cause = limits.least() == limits.sound   ? "its sound speed"
                      : limits.least() == limits.force ? "gravity"
                                                       : "its viscosity";
  scene.fail(
      "run", "time_step",
      fmt::format(
          "[s] is above the stability limit {} s of the fluid, set by {}; use {} s or less, or a larger fluid.spacing",
          base::roundedDown(2 * limits.least(), 3), cause, base::roundedDown(limits.least(), 3)));
}

/// Throws InputError for a given step above the stability limit of the contacts. `automatic` [s]: the step of "auto".
void checkGivenStep(const scene::Scene& scene, const StepLimit& limit, double automatic) {
  checkTimeScales(scene, *scene.run.timeStep);
  const bool hertz = !hasComplementarity(scene) && std::any_of(scene.materials.begin(), scene.materials.end(),
                                                               [](const scene::Material& m) { return m.hertzian(); });
  if (*scene.run.timeStep > limit.step) {
    const std::string most = base::roundedDown(limit.step, 3);
    scene.fail("run", "time_step",
               fmt::format("[s] is above {} s, the stability limit of the stiffest contact in the scene ({}); set {} s "
                           "or less (\"auto\": {} s), or {}{}",
                           most, limit.what, most, base::roundedDown(automatic, 3), limit.remedy,
                           hertz ? fmt::format("; hertz contacts are evaluated at run.impact_speed = {:g} m/s",
                                               scene.run.impactSpeed)
                                 : ""));
  }
  if (scene.fluid) checkFluidStep(scene);
}

/// Complementarity contacts do not limit the step; contacts between parts do.
double implicitTimeStep(const scene::Scene& scene, const ContactPairs& pairs) {
  const StepLimit limit = stepLimit(scene, pairs, {});
  double automatic =
      std::min({complementarityTimeStep(scene, pairs), resolvingStep(timeScales(scene), scene.run.stepsPerPeriod),
                kCalmShare * limit.calm, limit.step, limit.bounce / scene.run.stepsPerContact, kLongestOfAll,
                scene.run.duration});
  if (scene.vehicle) automatic = std::min(automatic, kVehicleTimeStep);
  if (scene.mechanism.touches() && !scene.vehicle) automatic = std::min(automatic, mechanismTimeStep(scene));
  if (!scene.run.timeStep) return automatic;
  checkGivenStep(scene, limit, automatic);
  return *scene.run.timeStep;
}

} // namespace

StepLimit stepLimit(const scene::Scene& scene) {
  const ContactPairs pairs(scene);
  return stepLimit(scene, pairs, grainContacts(scene, pairs));
}

double shortestContact(const scene::Scene& scene) { return shortestOf(grainContacts(scene, ContactPairs(scene))); }

double chooseTimeStep(const scene::Scene& scene) {
  if (!scene.mechanism.empty() && !scene.mechanism.touches() && !scene.vehicle) return mechanismTimeStep(scene);
  const ContactPairs pairs(scene);
  checkSoftness(scene, pairs);
  if (hasComplementarity(scene) && pairs.kinds.any()) return implicitTimeStep(scene, pairs);
  const std::vector<GrainContact> contacts = grainContacts(scene, pairs);
  const StepLimit limit = stepLimit(scene, pairs, contacts);
  const double contact = shortestOf(contacts);
  // A different number of steps per contact scales all other bounds of grains, down to the limits.
  const double coarser = scene::kStepsPerContact / scene.run.stepsPerContact;
  const bool fluidAlone = scene.fluid && !scene.vehicle && scene.mechanism.empty();
  double automatic = contact > 0 ? contact / scene.run.stepsPerContact : fluidAlone ? kLongestOfAll : kVehicleTimeStep;
  automatic = std::min({automatic, std::min(1.0, kCalmShare * coarser) * limit.calm, limit.step,
                        limit.bounce / scene.run.stepsPerContact});
  for (const auto& [material, radius, largest] : pairs.kinds.kinds)
    automatic =
        std::min(automatic, coarser * kRayleighShare * contact::rayleighTimeOf(scene.material(material), radius));
  automatic = std::min(automatic, resolvingStep(timeScales(scene), scene.run.stepsPerPeriod));
  if (!scene.mechanism.empty() && !scene.vehicle) automatic = std::min(automatic, mechanismTimeStep(scene));
  if (scene.fluid) automatic = std::min(automatic, fluidStepLimits(scene).least());
  // The range of run.time_step also limits "auto".
  automatic = std::min({automatic, kLongestOfAll, scene.run.duration});
  if (!scene.run.timeStep) return automatic;
  checkGivenStep(scene, limit, automatic);
  return *scene.run.timeStep;
}

namespace {

/// Rounding tolerance, so that exact multiples of a limit remain allowed.
constexpr double kRounding = 1 + 1e-12;

/// Largest distance of a point of a surface from the rotation axis [m], except points of surfaces of revolution about
/// it; 0 for planes, which are unbounded.
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

void checkBodySpeeds(const scene::Scene& scene, const ContactPairs& pairs, double timeStep) {
  if (!scene.mechanism.touches()) return;
  const coupling::MechanismSetup mechanism = mechanismSetup(scene);
  double smallest = base::kInfinity;
  if (pairs.kinds.any()) smallest = pairs.kinds.smallest;
  for (const coupling::BodyShape& s : mechanism.shapes) smallest = std::min(smallest, coupling::minFeature(s));
  const double most = kRounding * 0.5 * smallest / timeStep;
  for (const coupling::BodyShape& s : mechanism.shapes) {
    const std::size_t section = s.body - mechanism.ofVehicle.bodies;
    const scene::BodySection& body = scene.mechanism.bodies[section];
    const double speed = norm(body.velocity) + norm(body.spin) * (norm(s.pose_B.position) + norm(halfExtent(s.shape)));
    if (speed > most)
      scene.fail("body", section, "velocity",
                 fmt::format("[m/s] and spin move a shape by up to {:.4g} m per step of {:.3g} s, more than {:.4g} m "
                             "(half the smallest grain radius or a quarter of the thinnest shape), so it could pass "
                             "through other objects; lower them, or set run.time_step to {} s or less",
                             speed * timeStep, timeStep, 0.5 * smallest, base::roundedDown(0.5 * smallest / speed, 4)));
  }
}

void checkSurfaceSpeeds(const scene::Scene& scene, const ContactPairs& pairs, double timeStep) {
  const bool implicit = hasComplementarity(scene);
  const double share = implicit ? terrain::GrainModel::kMaxWaySolved : 0.5;
  const double most = kRounding * share * pairs.kinds.smallest / timeStep;
  for (const SceneSurface& s : pairs.surfaces) {
    // Only the motion of a plane along its normal counts: a belt may have any speed.
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
                 fmt::format("moves {} at up to {:.4g} m/s, i.e. by more than {} the smallest grain radius per step of "
                             "{:.3g} s, so it could pass through a grain without contact; keep it below {} m/s "
                             "(velocity, spin, amplitude, frequency), or lower run.time_step",
                             s.name, shifts + turns, implicit ? "0.4 of" : "half", timeStep,
                             base::roundedDown(most, 4)));
  }
}

} // namespace

void checkSpeeds(const scene::Scene& scene, const ContactPairs& pairs, double timeStep) {
  if (!pairs.kinds.any()) return;
  checkSurfaceSpeeds(scene, pairs, timeStep);
  checkBodySpeeds(scene, pairs, timeStep);
  const bool implicit = hasComplementarity(scene);
  const double most = kRounding * (implicit ? terrain::GrainModel::kMaxWaySolved : 0.5 * scene.run.skin) *
                      pairs.kinds.smallest / timeStep;
  const std::string beyond = implicit ? "moves a grain by more than 0.4 of the smallest radius"
                                      : "moves a grain by more than half the skin distance";
  const std::string remedy = implicit ? "" : ", or raise run.skin";
  const auto check = [&](const char* list, const auto& sections) {
    for (std::size_t k = 0; k < sections.size(); ++k)
      if (norm(sections[k].velocity) > most)
        scene.fail(list, k, "velocity",
                   fmt::format("[m/s] {} per step of {:.3g} s; keep it below {} m/s, or lower run.time_step{}", beyond,
                               timeStep, base::roundedDown(most, 4), remedy));
  };
  check("grain", scene.grains), check("grains", scene.fills), check("source", scene.sources);
  for (std::size_t k = 0; k < scene.fills.size(); ++k)
    for (const scene::Grain& g : scene.fills[k].fromFile)
      if (norm(g.velocity) > most)
        scene.fail("grains", k, "file",
                   fmt::format("has a grain at ({:.6g}, {:.6g}, {:.6g}) m with a velocity of {:.4g} m/s, which {} per "
                               "step of {:.3g} s; keep it below {} m/s, or lower run.time_step{}",
                               g.position.x, g.position.y, g.position.z, norm(g.velocity), beyond, timeStep,
                               base::roundedDown(most, 4), remedy));
}

} // namespace grouser::setup

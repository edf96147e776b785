// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/vehicle_step_limit.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/scm_setup.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace grouser::setup {

namespace {

/// Limit for the idler on the tangential springs of all shoes on half of its circumference: all springs rotate it, half
/// shift it along each axis, and each spring moves its shoe. A track tension T presses a shoe with T pitch / radius;
/// for the overlap see considerPressedShoe(). At longer steps, sticking contacts vibrate within Coulomb's limit.
void considerIdler(StepLimit& limit, const vehicle::VehicleSpec& s) {
  const vehicle::ContactSpec& c = s.contact;
  if (c.frictionInside <= 0) return;
  const double around = s.idlerPinRadius(), radius = s.idler.radius;
  const double shoes = std::ceil(base::kPi * around / s.shoe.pitch);
  const double load = 0.5 * s.idler.preload * s.shoe.pitch / around;
  const double strip = c.foundationModulus * 2 * s.shoe.padHalfWidth * std::sqrt(2 * radius);
  const double spring = c.tangentialRatio * 2 * strip * std::sqrt(base::pow(0.75 * load / strip, 2.0 / 3));
  const double top = s.shoe.plateTop;
  const double rate = spring * (shoes * (radius * radius / s.idler.inertia.y + 0.5 / s.idler.mass) + 1 / s.shoe.mass +
                                top * top / s.shoe.inertia.y);
  considerBoth(limit, rate, rate * c.relaxationTime, fmt::format("idler in contact with {:g} shoes", shoes),
               "lower contact.tangential_ratio or idler.preload in vehicle.spec");
}

/// Returns true if shoes touch deformable soil only.
bool meetsSoilOnly(const scene::Scene& scene) {
  return scene.deformable() && obstaclesOf(scene).empty() && !scene.mechanism.touches();
}

/// Limits of the foundation between parts: shoes on rigid ground, and wheels on shoes.
void considerParts(StepLimit& limit, const scene::Scene& scene, const vehicle::VehicleSpec& s) {
  const vehicle::ContactSpec& c = s.contact;
  // A shoe on its whole pad: the maximum stiffness of the foundation. No wheel presses a whole pad.
  const double pad =
      std::max(c.foundationModulus, c.onGround()) * 4 * s.shoe.halfLength * s.shoe.padHalfWidth / s.shoe.mass;
  const std::string modulus = c.onGround() > c.foundationModulus ? "contact.pad_modulus" : "contact.foundation_modulus";
  if (!meetsSoilOnly(scene))
    considerBoth(limit, pad, pad * c.relaxationTime, "shoe on rigid ground or wheel",
                 fmt::format("lower {} in vehicle.spec", modulus));
  // A wheel that overlaps the plate by 1 mm, far more than weight causes.
  constexpr double kDeep = 1e-3; // [m]
  const auto wheel = [&](const char* name, double mass, double radius) {
    const double area = 4 * s.shoe.padHalfWidth * std::sqrt(2 * radius * kDeep);
    const double stiffness = c.foundationModulus * area * (1 / mass + 1 / s.shoe.mass);
    considerBoth(limit, stiffness, stiffness * c.relaxationTime, fmt::format("{} of {:g} kg on shoes", name, mass),
                 "raise its mass or lower contact.foundation_modulus in vehicle.spec");
  };
  wheel("road wheel", s.roadWheel.mass, s.roadWheel.radius);
  wheel("idler", s.idler.mass, s.idler.radius);
  if (!s.roller.x.empty()) wheel("roller", s.roller.mass, s.roller.radius);
  considerIdler(limit, s);
}

/// Returns true if shoes can touch rigid surfaces.
bool hasRigidGround(const scene::Scene& scene) {
  return (scene.terrain && !scene.terrain->granular()) || !obstaclesOf(scene).empty();
}

/// Limit for a shoe between rigid ground and a wheel. The highest mode with both springs is at most the sum of the
/// highest modes with the ground only (whole pad, translation and rotation) and with the wheel on the shoe's end only
/// (Weyl). The wheel's overlap follows from its share of the weight, F = 4/3 modulus width sqrt(2 R) depth^(3/2).
/// docs/evidence/vehicle_stability.md records the limits that `grouser study stability --scene vehicle` finds.
void considerPressedShoe(StepLimit& limit, const scene::Scene& scene, const vehicle::VehicleSpec& s) {
  if (!hasRigidGround(scene)) return;
  const vehicle::ContactSpec& c = s.contact;
  const double length = s.shoe.halfLength, width = s.shoe.padHalfWidth, mass = s.shoe.mass;
  const std::optional<coupling::ScmSetup> soil = scmSetup(scene);
  const double modulus = soil ? soil->stiffest(2 * width) : c.onGround();
  const double pad = modulus * 4 * length * width;
  const double onGround =
      pad * std::max({1 / mass, length * length / (3 * s.shoe.inertia.y), width * width / (3 * s.shoe.inertia.x)});
  const double load = s.totalMass() * norm(scene.run.gravity) / (2 * s.roadWheel.count);
  const double strip = c.foundationModulus * 2 * width * std::sqrt(2 * s.roadWheel.radius);
  const double depth = load > 0 ? base::pow(0.75 * load / strip, 2.0 / 3) : 0;
  const double underWheel =
      2 * strip * std::sqrt(depth) * (1 / s.roadWheel.mass + 1 / mass + length * length / s.shoe.inertia.y);
  const double both = onGround + underWheel;
  const double damped =
      soil ? onGround / modulus * soil->soil.damping + underWheel * c.relaxationTime : both * c.relaxationTime;
  consider(limit, both, damped, soil ? "shoe on soil under a road wheel" : "shoe on rigid ground under a road wheel",
           soil ? "lower scm.elastic_ratio" : "lower contact.foundation_modulus in vehicle.spec");
}

} // namespace

void considerVehicle(StepLimit& limit, const scene::Scene& scene, const vehicle::VehicleSpec& spec) {
  considerParts(limit, scene, spec);
  considerPressedShoe(limit, scene, spec);
}

} // namespace grouser::setup

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/scm_setup.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/scm_constants.hpp"
#include "vehicle/spec_file.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace grouser::setup {

using scene::SoilQuantity;

namespace {

/// [scm] bulk_density, or the bulk density of the soil [kg/m3].
double bulkDensity(const ScmConstants& constants) {
  constexpr double kUsual = 1600, kPorosity = 0.4; // without a soil file, or without porosity in it
  if (constants.section().bulkDensity) return *constants.section().bulkDensity;
  if (const auto published = constants.published(SoilQuantity::bulkDensity)) return *published;
  const scene::Soil* soil = constants.soil();
  return soil ? soil->material.density * (1 - soil->grains.porosity.value_or(kPorosity)) : kUsual;
}

/// Lyasko's rule (1 + i) / (1 - i / 2) at small slip i, as a local sinkage per shear displacement: 3 z / L [-].
double lyaskoSlipSinkage(const scm::SoilConstants& soil, const vehicle::VehicleSpec& spec, double gravity) {
  const double length = (spec.roadWheel.count - 1) * spec.roadWheel.spacing, breadth = 2 * spec.shoe.padHalfWidth;
  if (!(length > 0)) return 0;
  const double pressure = spec.totalMass() * gravity / (2 * length * breadth);
  return 3 * soil.sinkageUnder(pressure, breadth) / length;
}

/// Default node spacing under bodies [m]: an eighth of the smallest width of a shape.
double spacingUnder(const std::vector<coupling::BodyShape>& shapes) {
  double least = base::kInfinity;
  for (const coupling::BodyShape& s : shapes) {
    const base::Vec3d half = halfExtent(s.shape);
    std::array<double, 3> sides = {half.x, half.y, half.z};
    std::sort(sides.begin(), sides.end());
    least = std::min(least, std::max(sides[0], sides[1] / 4) / 4);
  }
  return least;
}

/// Default node spacing under bodies of a scene [m]; infinite without bodies.
double spacingUnder(const scene::Scene& scene) {
  return scene.mechanism.touches() ? spacingUnder(mechanismSetup(scene).shapes) : base::kInfinity;
}

/// Throws InputError if the soil has no bearing capacity under a width b [m].
void requireStrength(const scene::Scene& scene, const scm::SoilConstants& soil, double b, const std::string& under) {
  if (soil.modulusAt(b) > 0) return;
  scene.fail("terrain", "kind",
             fmt::format("has no bearing capacity: k_c / b + k_phi is {:.4g} N/m^(n+2) for {} of width b = {:g} m; "
                         "correct scm.k_c or scm.k_phi",
                         soil.modulusAt(b), under, b));
}

} // namespace

std::optional<coupling::ScmSetup> scmSetup(const scene::Scene& scene) {
  if (!scene.deformable()) return {};
  const ScmConstants constants(scene);
  const scene::Scm& s = constants.section();
  coupling::ScmSetup setup;
  scm::SoilConstants& soil = setup.soil;
  soil.exponent = constants.value(SoilQuantity::exponent);
  soil.kc = constants.value(SoilQuantity::cohesiveModulus);
  soil.kphi = constants.value(SoilQuantity::frictionalModulus);
  soil.cohesion = constants.value(SoilQuantity::cohesion);
  const double phi = constants.value(SoilQuantity::frictionAngle);
  soil.friction = base::tan(phi * base::kPi / 180);
  soil.shearDisplacement = constants.value(SoilQuantity::shearModulus);
  soil.unloadingStiffness = s.unloadingStiffness, soil.unloadingGrowth = s.unloadingGrowth;
  soil.elasticRatio = s.elasticRatio, soil.damping = s.damping;
  const double gravity = norm(scene.run.gravity);
  soil.unitWeight = bulkDensity(constants) * gravity;
  soil.slipSinkage = s.slipSinkage.value_or(0), soil.maximumSlipSinkage = s.maximumSlipSinkage.value_or(0);
  const double repose = s.reposeAngle ? *s.reposeAngle : constants.published(SoilQuantity::reposeAngle).value_or(phi);
  setup.displacement.share = s.displacedShare, setup.displacement.repose = base::tan(repose * base::kPi / 180);
  setup.deepest = s.deepest;
  if (!scene.vehicle && !scene.mechanism.touches())
    scene.fail("terrain", "kind",
               "has no effect without a [vehicle] or a [[body]] with shapes; add one, or remove [terrain]");
  double spacing = base::kInfinity;
  if (scene.mechanism.touches()) {
    const coupling::MechanismSetup mechanism = mechanismSetup(scene);
    spacing = spacingUnder(mechanism.shapes);
    for (const coupling::BodyShape& shape : mechanism.shapes)
      requireStrength(scene, soil, 8 * spacingUnder({shape}), "a body");
  }
  if (scene.vehicle) {
    const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
    const vehicle::ShoeSpec& shoe = spec.shoe;
    spacing = 0.5 * shoe.halfLength;
    requireStrength(scene, soil, 2 * shoe.padHalfWidth, "shoes");
    requireStrength(scene, soil, 2 * std::min(shoe.padHalfWidth, shoe.halfLength), "single shoes");
    soil.slipSinkage = s.slipSinkage.value_or(lyaskoSlipSinkage(soil, spec, gravity));
    soil.maximumSlipSinkage = s.maximumSlipSinkage.value_or(shoe.grouserHeight);
    if (s.nodeSpacing && *s.nodeSpacing > 2 * shoe.halfLength)
      scene.fail("scm", "node_spacing",
                 fmt::format("[m] exceeds the shoe length, {:g} m; remove the key to use a quarter of this length",
                             2 * shoe.halfLength));
  }
  setup.spacing = s.nodeSpacing.value_or(spacing);
  return setup;
}

std::string nodeSpacingWarning(const scene::Scene& scene) {
  constexpr double kSlightly = 1.01; // times the default
  if (!scene.deformable() || !scene.scm || !scene.scm->nodeSpacing) return {};
  const double spacing = *scene.scm->nodeSpacing;
  if (scene.vehicle) {
    const double length = 2 * vehicle::readVehicleSpec(scene.vehicle->source()).shoe.halfLength;
    if (spacing <= kSlightly * length / 4) return {};
    return fmt::format("scm.node_spacing, {:g} m, is {:.2g} of the length of a shoe; with more than the default, a "
                       "quarter, sinkage is too large: by 9 % at 3/8, 23 % at a half and 72 % at a whole shoe of the "
                       "light vehicle; set at most {:g}, or remove the key",
                       spacing, spacing / length, length / 4);
  }
  const double usual = spacingUnder(scene);
  if (spacing <= kSlightly * usual) return {};
  return fmt::format(
      "scm.node_spacing, {:g} m, exceeds the default, {:g} m, an eighth of the smallest body; tilted and "
      "round bodies have force errors up to 0.3 (node_spacing / sinkage)^2; set at most {:g}, or remove "
      "the key",
      spacing, usual, usual);
}

} // namespace grouser::setup

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/plan.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/material_pairs.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/scm_constants.hpp"
#include "runs/setup/scm_setup.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::commands {

namespace {

/// Returns true if contacts that do not involve grains depend on the material: elastic foundations of bodies, surfaces
/// and ground, or deformable soil.
bool actsWithoutGrains(const scene::Scene& scene, const std::string& material) {
  if (scene.deformable() && scene.terrain->material == material) return true;
  if (!scene.mechanism.touches()) return false;
  const auto& bodies = scene.mechanism.bodies;
  const std::vector<setup::SceneSurface> surfaces = setup::surfacesOf(scene);
  return (scene.terrain && scene.terrain->material == material) ||
         std::any_of(bodies.begin(), bodies.end(),
                     [&](const scene::BodySection& b) { return !b.shapes.empty() && b.material == material; }) ||
         std::any_of(surfaces.begin(), surfaces.end(),
                     [&](const setup::SceneSurface& s) { return s.section.material == material; });
}

/// Constants of deformable soil.
std::string soilText(const coupling::ScmSetup& setup, std::size_t width) {
  const scm::SoilConstants& soil = setup.soil;
  std::string text =
      fmt::format("  {:<{}}  n {:.4g}, k_c {:.4g} N/m^(n+1), k_phi {:.4g} N/m^(n+2), c {:.4g} Pa, tan phi {:.4g}, K "
                  "{:.4g} m; node spacing {:.4g} m\n",
                  "deformable soil", width, soil.exponent, soil.kc, soil.kphi, soil.cohesion, soil.friction,
                  soil.shearDisplacement, setup.spacing);
  text += fmt::format("  {:<{}}  slip sinkage {:.3g} up to {:.3g} m, {:.3g} of the rut volume displaced to the sides, "
                      "tan(angle of repose) {:.3g}, unit weight {:.4g} N/m3\n",
                      "", width, soil.slipSinkage, soil.maximumSlipSinkage, setup.displacement.share,
                      setup.displacement.repose, soil.unitWeight);
  return text;
}

} // namespace

std::string pairsText(const scene::Scene& scene) {
  std::string text, notes;
  const std::vector<setup::MaterialPair> pairs = setup::materialPairs(scene);
  std::size_t width = 24;
  const auto nameOf = [](const setup::MaterialPair& p) {
    return fmt::format("{}: {}, {}", p.what, p.grain, p.partner);
  };
  for (const setup::MaterialPair& p : pairs) width = std::max(width, nameOf(p).size());
  if (!pairs.empty())
    text += fmt::format("\ncontact parameters by material pair\n  {:<{}}  {:<6} {:>11} {:>11} {:>8} {:>8} {:>8}\n  "
                        "{:<{}}  {:<6} {:>11} "
                        "{:>11} {:>8} {:>8} {:>8}\n",
                        "materials", width, "law", "stiffness", "restitution", "friction", "rolling", "cohesion", "",
                        width, "", "N/m or Pa", "-", "-", "-", "J/m2");
  for (const setup::MaterialPair& p : pairs) {
    text += fmt::format("  {:<{}}  {:<6} {:>11.4g} {:>11.4g} {:>8.4g} {:>8.4g} {:>8.4g}\n", nameOf(p), width,
                        p.law.hertz ? "hertz" : "linear", p.stiffness, p.restitution, p.law.friction,
                        p.law.rollingFriction, p.cohesion);
    for (const std::string& off : p.off) notes += fmt::format("  note: {}: {}\n", p.what, off);
  }
  for (const scene::Material& m : scene.materials)
    if (!actsWithoutGrains(scene, m.name) &&
        std::none_of(pairs.begin(), pairs.end(),
                     [&](const setup::MaterialPair& p) { return p.grain == m.name || p.partner == m.name; }))
      notes += fmt::format("  note: material.{} has no effect in this scene{}\n", m.name,
                           scene.vehicle && pairs.empty()
                               ? ": the vehicle file defines all contact parameters between vehicle and rigid ground"
                               : "");
  if (scene.vehicle) {
    const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
    if (text.empty()) text += "\ncontact parameters by material pair\n";
    const auto part = [&](const char* what, double modulus, double friction) {
      text += fmt::format("  {:<{}}  elastic foundation {:.4g} N/m3, relaxation time {:.4g} s, friction {:.4g}\n", what,
                          width, modulus, spec.contact.relaxationTime, friction);
    };
    part("shoe on running gear", spec.contact.foundationModulus, spec.contact.frictionInside);
    if (scene.terrain && !scene.terrain->granular() && !scene.deformable())
      part("shoe on rigid ground", spec.contact.onGround(), spec.contact.frictionGround);
  }
  if (const std::optional<coupling::ScmSetup> soil = setup::scmSetup(scene))
    text += soilText(*soil, width) + setup::ScmConstants(scene).text();
  return text + notes;
}

} // namespace grouser::commands

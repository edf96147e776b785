// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/complementarity_setup.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {

namespace {

/// Rejects values that have no effect on complementarity contacts; runs write defaults into their own scene files.
void checkUnused(const scene::Scene& scene) {
  const scene::Complementarity usual, c = scene.complementarity.value_or(usual);
  if (c.compliance == contact::Compliance::law && c.recovery != usual.recovery)
    scene.fail("complementarity", "recovery",
               "[m/s] has no effect with compliance = \"law\"; remove it, or set compliance = \"rigid\"");
  // Beds settle with penalty contacts, and rigid parts touch each other with them.
  const bool settles = scene.terrain && scene.terrain->granular();
  if (settles || scene.vehicle || scene.mechanism.touches()) return;
  if (scene.run.stepsPerContact != scene::kStepsPerContact)
    scene.fail(
        "run", "steps_per_contact",
        "has no effect with contact = \"complementarity\", whose steps do not resolve contacts; remove it, or set "
        "run.time_step");
  for (const scene::Material& m : scene.materials)
    if (m.attraction)
      scene.failMaterial(
          m.name, "attraction",
          "has no effect with run.contact = \"complementarity\", whose dashpots never attract; remove it "
          "(to model cohesion, set cohesion), or set run.contact = \"penalty\"");
}

} // namespace

void checkComplementarity(const scene::Scene& scene) {
  if (!hasComplementarity(scene)) return;
  const auto fail = [&](const std::string& message) { scene.fail("run", "contact", message); };
  if (!ContactPairs(scene).kinds.any()) fail("has no effect without grains; remove it, or add grains");
  for (const scene::Material& m : scene.materials)
    if (m.yields())
      scene.failMaterial(
          m.name, "law",
          "is elastic-plastic, which complementarity contacts do not support; use \"linear\", \"hertz\", or "
          "run.contact = \"penalty\"");
  for (const scene::Material& m : scene.materials)
    if (m.crushingStrength.value_or(0) > 0)
      scene.failMaterial(
          m.name, "crushing_strength",
          "[Pa] is not supported with complementarity contacts; remove it, or use run.contact = \"penalty\"");
  checkUnused(scene);
  const bool rigid = scene.complementarity && scene.complementarity->compliance == contact::Compliance::rigid;
  for (const scene::Material& m : scene.materials)
    if (rigid && m.cohesion > 0)
      scene.failMaterial(m.name, "cohesion",
                         "[J/m2] requires contact overlap, which rigid contacts do not have; set "
                         "complementarity.compliance = \"law\"");
  for (const scene::ContactPair& p : scene.contacts)
    if (rigid && p.cohesion.value_or(0) > 0)
      fail(fmt::format("has rigid contacts, but contact.\"{}|{}\" has cohesion, which requires contact overlap; set "
                       "complementarity.compliance = \"law\"",
                       p.first, p.second));
  if (scene.output.fieldsCell)
    scene.fail("output", "fields_cell",
               "[m] requires penalty contacts, since stresses are computed from contact springs; remove it, or set "
               "run.contact = \"penalty\"");
  if (!scene.run.residual && norm(scene.run.gravity) == 0)
    scene.fail("run", "residual",
               "[m/s] cannot be \"auto\" with run.gravity = 0, since \"auto\" is 0.01 of the speed that gravity adds "
               "per step; set a value");
}

bool hasComplementarity(const scene::Scene& scene) {
  return scene.run.contact == scene::ContactMethod::complementarity;
}

std::optional<contact::ComplementarityOptions> complementarityOptions(const scene::Scene& scene, double timeStep) {
  if (!hasComplementarity(scene)) return {};
  const scene::Complementarity c = scene.complementarity.value_or(scene::Complementarity{});
  const double fall = norm(scene.run.gravity) * timeStep;
  contact::ComplementarityOptions options;
  options.friction = c.friction, options.compliance = c.compliance;
  options.iterations = static_cast<int>(c.iterations);
  options.recovery = c.recovery, options.strict = c.strict;
  options.residual = scene.run.residual.value_or(0.01 * fall);
  options.impact = 5 * fall, options.reach = 2 * scene.run.impactSpeed * timeStep;
  return options;
}

double complementarityTimeStep(const scene::Scene& scene, const ContactPairs& pairs) {
  const double diameter = 2 * pairs.kinds.smallest, gravity = norm(scene.run.gravity);
  const double falls = gravity > 0 ? 0.03 * std::sqrt(diameter / gravity) : base::kInfinity;
  return std::min(falls, 0.08 * diameter / scene.run.impactSpeed);
}

} // namespace grouser::setup

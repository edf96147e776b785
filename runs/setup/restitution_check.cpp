// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/restitution_check.hpp"

#include "base/rounded.hpp"
#include "base/table.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/step_limit.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace grouser::setup {

namespace {

/// Minimum restitution; it requires 500 times the critical damping.
constexpr double kMinRestitution = 1e-6;

/// Step limit [s] of a scene with the minimum restitution.
double stepAtLeastRestitution(scene::Scene scene) {
  const auto raise = [](std::optional<double>& restitution) {
    if (restitution) restitution = std::max(*restitution, kMinRestitution);
  };
  for (scene::Material& m : scene.materials) raise(m.restitution);
  for (scene::ContactPair& p : scene.contacts) raise(p.restitution);
  return stepLimit(scene).step;
}

void checkPair(const scene::Scene& scene, const std::string& nameA, const std::string& nameB) {
  const scene::Material &a = scene.material(nameA), &b = scene.material(nameB);
  const scene::ContactPair* pair = scene.contact(nameA, nameB);
  if ((a.attraction && b.attraction) || (pair && pair->damping)) return;
  const bool given = pair && pair->restitution;
  const scene::Material& least = b.restitution.value_or(1) < a.restitution.value_or(1) ? b : a;
  if ((given ? *pair->restitution : least.restitution.value_or(1)) >= kMinRestitution) return;
  const std::string message = fmt::format(
      "[-] is below {:g}, the minimum without attraction, and would require time steps of {} s or less; raise it, set "
      "attraction = true in {} (0 then means critical damping), or set run.contact = \"complementarity\"",
      kMinRestitution, base::roundedDown(stepAtLeastRestitution(scene), 3),
      &a == &b ? "material." + a.name : fmt::format("material.{} and material.{}", a.name, b.name));
  if (given && scene.document)
    for (const auto& [name, section] : scene.document->root().named("contact"))
      if (name == pair->first + "|" + pair->second) section.fail("restitution", message);
  scene.failMaterial(least.name, "restitution", message);
}

} // namespace

void checkRestitutions(const scene::Scene& scene) {
  if (hasComplementarity(scene)) return;
  const ContactPairs pairs(scene);
  for (const std::string& grain : pairs.kinds.material)
    for (const ContactPartner& partner : pairs.partners) checkPair(scene, grain, partner.materialAgainst(grain));
}

} // namespace grouser::setup

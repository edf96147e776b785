// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/laws.hpp"

#include "contact/mixing.hpp"
#include "runs/scene/scene.hpp"

#include <fmt/format.h>

namespace grouser::setup {

contact::ContactLaw pairLaw(const scene::Scene& scene, const std::string& nameA, const std::string& nameB,
                            std::optional<double> effectiveMass) {
  const scene::Material &a = scene.material(nameA), &b = scene.material(nameB);
  const contact::PairProperties* pair = scene.contact(nameA, nameB);
  try {
    return contact::mixedLaw(a, b, pair ? *pair : contact::PairProperties{}, effectiveMass);
  } catch (const contact::MixingError& error) {
    const scene::Material &at = error.inSecond ? b : a, &other = error.inSecond ? a : b;
    if (error.reason == contact::MixingError::Reason::lawsDiffer)
      scene.failMaterial(
          at.name, error.key,
          fmt::format("does not go with law = \"{}\" of material.{}, which it meets: surfaces that touch "
                      "must both be hertz or eepa, or both linear, eepa_linear or luding, and no "
                      "eepa_linear meets luding; give both one of the two",
                      base::wordOf(other.law), other.name));
    if (error.reason == contact::MixingError::Reason::dampingBesideRestitution)
      scene.failMaterial(
          at.name, error.key,
          fmt::format("[1/s] cannot be compared with the restitution of material.{} among grains of many "
                      "masses; give both the same way, or [contact.\"{}|{}\"] for the pair",
                      other.name, a.name, b.name));
    scene.failMaterial(at.name, error.key, "[Pa] is missing; add it, e.g. young = 7e7");
  }
}

} // namespace grouser::setup

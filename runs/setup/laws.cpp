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
          fmt::format("is incompatible with law = \"{}\" of material.{}, a contact partner; use hertz or eepa for "
                      "both, or linear, eepa_linear or luding for both (eepa_linear and luding are incompatible)",
                      base::wordOf(other.law), other.name));
    if (error.reason == contact::MixingError::Reason::dampingBesideRestitution)
      scene.failMaterial(
          at.name, error.key,
          fmt::format("[1/s] cannot be combined with the restitution of material.{} for grains of different masses; "
                      "use damping or restitution in both materials, or set [contact.\"{}|{}\"]",
                      other.name, a.name, b.name));
    scene.failMaterial(at.name, error.key, "[Pa] is missing; add it, e.g. young = 7e7");
  }
}

} // namespace grouser::setup

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/scm_constants.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace grouser::setup {

using scene::ContactConstant;
using scene::SoilQuantity;

namespace {

/// The key of [scm] for a constant.
const std::optional<double>& givenIn(const scene::Scm& scm, SoilQuantity quantity) {
  switch (quantity) {
  case SoilQuantity::exponent:
    return scm.n;
  case SoilQuantity::cohesiveModulus:
    return scm.kc;
  case SoilQuantity::frictionalModulus:
    return scm.kphi;
  case SoilQuantity::cohesion:
    return scm.cohesion;
  case SoilQuantity::frictionAngle:
    return scm.frictionAngle;
  default:
    return scm.shearDisplacement;
  }
}

} // namespace

ScmConstants::ScmConstants(const scene::Scene& scene) : scene_(scene), scm_(scene.scm.value_or(scene::Scm{})) {
  const auto found = scene.soils.find(scene.terrain->material);
  if (found != scene.soils.end()) soil_ = found->second.get();
  const auto ofSoil = soil_ ? scene::contactConstants(*soil_, scm_.constants) : std::vector<ContactConstant>{};
  for (const SoilQuantity q : scene::kContactQuantities) {
    if (const std::optional<double>& given = givenIn(scm_, q))
      nominal_.push_back({q, *given, 0, false});
    else if (const ContactConstant* c = scene::findConstant(ofSoil, q))
      nominal_.push_back(*c);
  }
  used_ = nominal_;
  if (scm_.constantsDraw > 0) scene::drawContactConstants(used_, scm_.constantsDraw);
}

std::optional<double> ScmConstants::published(SoilQuantity quantity) const {
  const scene::PublishedConstant* found = soil_ ? soil_->publishedValue(quantity) : nullptr;
  return found ? std::optional(found->value) : std::nullopt;
}

double ScmConstants::value(SoilQuantity quantity) const {
  if (const ContactConstant* c = scene::findConstant(used_, quantity)) return c->value;
  std::vector<std::string> keys, words;
  for (const SoilQuantity q : scene::kContactQuantities) {
    if (scene::findConstant(used_, q)) continue;
    words.emplace_back(base::wordOf(q));
    keys.push_back(fmt::format("scm.{} [{}]", words.back(), unitOf(q)));
  }
  const std::string why =
      soil_ ? fmt::format("the soil {} has no {} {}", soil_->name, base::wordOf(scm_.constants), fmt::join(words, ", "))
            : fmt::format("the soil file {} does not exist", scene_.terrain->material);
  scene_.fail(
      "terrain", "kind",
      fmt::format("requires {}: {}; add {} to [scm]", fmt::join(keys, ", "), why, keys.size() > 1 ? "them" : "it"));
}

std::string ScmConstants::text() const {
  std::string text = "\nconstants of the deformable soil";
  if (soil_) text += fmt::format(" {} ({})", soil_->name, base::wordOf(scm_.constants));
  text += scm_.constantsDraw > 0
              ? fmt::format(": sample {} and nominal values, with 95 % intervals\n", scm_.constantsDraw)
              : std::string(": nominal values with 95 % intervals\n");
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const ContactConstant& c = nominal_[i];
    const std::string value = scm_.constantsDraw > 0 ? fmt::format("{:<11.5g} ", used_[i].value) : "";
    const std::string interval =
        givenIn(scm_, c.quantity)
            ? fmt::format(" {} (set in the scene)", unitOf(c.quantity))
            : fmt::format(" +- {:.2g} {}{}", c.halfWidth(), unitOf(c.quantity), c.isAssumed ? " (assumed)" : "");
    text += fmt::format("  {:<6} {}{:.5g}{}\n", base::wordOf(c.quantity), value, c.value, interval);
  }
  if (soil_) text += "  " + scene::jointDistributionText(nominal_) + "\n";
  return text;
}

} // namespace grouser::setup

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/scm_setup.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/soil.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>

namespace grouser::setup {

namespace {

using scene::SoilQuantity;

/// Constants of [scm], or of the soil file.
class Constants {
public:
  explicit Constants(const scene::Scene& scene) : scene_(scene), scm_(scene.scm.value_or(scene::Scm{})) {
    const auto found = scene.soils.find(scene.terrain->material);
    if (found != scene.soils.end()) soil_ = found->second.get();
  }
  const scene::Scm& section() const { return scm_; }

  double value(const std::optional<double>& given, SoilQuantity quantity) const {
    if (given) return *given;
    const bool published = scm_.constants == scene::SoilConstantsFrom::published;
    if (soil_) {
      for (const scene::PublishedConstant& p : soil_->published)
        if (published && p.quantity == quantity) return p.value;
      for (const scene::ReachedConstant& r : soil_->reached)
        if (!published && r.quantity == quantity) return r.value;
    }
    const std::string word(base::wordOf(quantity));
    const std::string why =
        soil_ ? fmt::format("the soil {} has no {} {}", soil_->name, base::wordOf(scm_.constants), word)
              : fmt::format("there is no soil file {}", scene_.terrain->material);
    scene_.fail("terrain", "kind", fmt::format("needs scm.{} [{}]: {}; give it in [scm]", word, unitOf(quantity), why));
  }

private:
  const scene::Scene& scene_;
  scene::Scm scm_;
  const scene::Soil* soil_{};
};

} // namespace

std::optional<coupling::ScmSetup> scmSetup(const scene::Scene& scene) {
  if (!scene.terrain || !scene.terrain->deformable()) return {};
  const Constants constants(scene);
  const scene::Scm& s = constants.section();
  coupling::ScmSetup setup;
  scm::SoilConstants& soil = setup.soil;
  soil.exponent = constants.value(s.n, SoilQuantity::exponent);
  soil.kc = constants.value(s.kc, SoilQuantity::cohesiveModulus);
  soil.kphi = constants.value(s.kphi, SoilQuantity::frictionalModulus);
  soil.cohesion = constants.value(s.cohesion, SoilQuantity::cohesion);
  soil.friction = base::tan(constants.value(s.frictionAngle, SoilQuantity::frictionAngle) * base::kPi / 180);
  soil.shearDisplacement = constants.value(s.shearDisplacement, SoilQuantity::shearModulus);
  soil.unloadingStiffness = s.unloadingStiffness, soil.unloadingGrowth = s.unloadingGrowth;
  soil.elasticRatio = s.elasticRatio, soil.damping = s.damping;
  setup.deepest = s.deepest;
  if (!scene.vehicle)
    scene.fail("terrain", "kind",
               "supports track shoes only, but the scene has no [vehicle]; add it, or set kind = \"rigid\"");
  if (scene.mechanism.touches())
    scene.fail("terrain", "kind",
               "supports track shoes only, but a [[body]] of the scene touches the ground; remove its "
               "shapes, or set kind = \"rigid\"");
  const vehicle::ShoeSpec shoe = vehicle::readVehicleSpec(scene.vehicle->source()).shoe;
  setup.spacing = s.nodeSpacing.value_or(0.5 * shoe.halfLength);
  const double b = 2 * shoe.padHalfWidth;
  if (!(soil.modulusAt(b) > 0))
    scene.fail(
        "terrain", "kind",
        fmt::format(
            "has no bearing capacity: k_c / b + k_phi is {:.4g} N/m^(n+2) for shoes of width b = {:g} m; correct "
            "scm.k_c or scm.k_phi",
            soil.modulusAt(b), b));
  if (setup.spacing > 2 * shoe.halfLength)
    scene.fail(
        "scm", "node_spacing",
        fmt::format("[m] is more than the length of a shoe, {:g} m; give at most that, and half of it for figures",
                    2 * shoe.halfLength));
  return setup;
}

} // namespace grouser::setup

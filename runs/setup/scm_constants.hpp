// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/soil_constants.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// Constants of [scm], or of the soil file: nominal ones, or the sample of constants_draw. Constants given in the scene
/// are not sampled.
class ScmConstants {
public:
  explicit ScmConstants(const scene::Scene& scene);

  const scene::Scm& section() const { return scm_; }
  const scene::Soil* soil() const { return soil_; } ///< soil of the terrain's material; null without a soil file
  /// A published constant of the soil file; empty if it has none.
  std::optional<double> published(scene::SoilQuantity quantity) const;
  /// Throws base::InputError with all missing constants if neither the scene nor the soil file has this one.
  double value(scene::SoilQuantity quantity) const;
  /// Constants of the scene or the soil file: values in use, nominal values, intervals, one per line.
  std::string text() const;

private:
  const scene::Scene& scene_;
  scene::Scm scm_;
  const scene::Soil* soil_{};
  std::vector<scene::ContactConstant> nominal_, used_; ///< deviation 0 for constants given in the scene
};

} // namespace grouser::setup

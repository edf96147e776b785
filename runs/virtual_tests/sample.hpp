// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/settled_ground.hpp"

#include <cstdint>
#include <string>

/// Samples of grains that the macroscopic studies prepare, from scenes as a user would write them.
namespace grouser::virtual_tests {

/// Spheres of one size. Stiff enough that overlaps under their own weight stay below a thousandth of a diameter.
struct SampleGrains {
  double radius = 0.005;    ///< [m]
  double density = 2500;    ///< [kg/m3]
  double stiffness = 1e5;   ///< [N/m]
  double young = 0;         ///< [Pa] above 0: Hertz' contacts with this modulus instead of linear ones
  double restitution = 0.5; ///< [-]
  double friction = 0.5;    ///< [-]
  double rollingFriction = 0;
  /// Keys of a scene's [material], a line each, but for density and friction: any law that a scene may have, instead of
  /// the springs, restitution and rolling friction above. Empty: those.
  std::string law;
  double diameter() const { return 2 * radius; }
  double mass() const;
  std::string toml(const std::string& name) const; ///< [material.NAME]
};

/// A sample and its step.
struct Sample {
  double timeStep = 0; ///< [s]
  coupling::LaidGround ground;
  terrain::Grains& grains() const { return *ground.grains; }
};

/// Builds the grains of a scene; its step is the scene's own.
Sample buildSample(const std::string& toml, const base::Exec& exec);

void advanceSample(terrain::Grains& grains, std::int64_t steps);

/// Steps until the mean kinetic energy a grain is below `agitation` of m g d, looked at every 0.02 s, or until `limit`
/// [s] have passed. Returns the time taken [s]; negative where it did not come to rest. Throws Stopped after a signal.
double bringToRest(Sample& sample, double agitation, double limit);

} // namespace grouser::virtual_tests

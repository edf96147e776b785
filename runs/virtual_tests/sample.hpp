// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/settled_ground.hpp"

#include <cstdint>
#include <string>

/// Samples of grains for macroscopic studies, from scene files.
namespace grouser::virtual_tests {

/// Equal spheres. With the default stiffness, the weight of a grain causes overlaps below 1e-3 diameters.
struct SampleGrains {
  double radius = 0.005;    ///< [m]
  double density = 2500;    ///< [kg/m3]
  double stiffness = 1e5;   ///< [N/m]
  double young = 0;         ///< [Pa] above 0: Hertz contacts with this Young's modulus instead of linear contacts
  double restitution = 0.5; ///< [-]
  double friction = 0.5;    ///< [-]
  double rollingFriction = 0;
  /// Keys of a scene's [material], one per line, without density and friction. They define any contact law, and replace
  /// the spring, restitution and rolling friction above. Empty: no replacement.
  std::string law;
  double diameter() const { return 2 * radius; }
  double mass() const;
  std::string toml(const std::string& name) const; ///< [material.NAME]
};

/// A sample and its time step.
struct Sample {
  double timeStep = 0; ///< [s]
  coupling::LaidGround ground;
  terrain::Grains& grains() const { return *ground.grains; }
};

/// Builds the grains of a scene, with the time step of the scene.
Sample buildSample(const std::string& toml, const base::Exec& exec);

void advanceSample(terrain::Grains& grains, std::int64_t steps);

/// Steps until the mean kinetic energy per grain is below `energyRatio` times m g d (checked every 0.02 s), or until
/// the time `limit` [s]. Returns the time [s]; negative if the sample is not at rest. Throws Stopped after a signal.
double bringToRest(Sample& sample, double energyRatio, double limit);

} // namespace grouser::virtual_tests

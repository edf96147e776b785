// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"

#include <memory>
#include <string>

/// Simulations of scenes that tests write as text.
namespace grouser::coupling {

/// The simulation of a scene, on one thread.
inline std::unique_ptr<Simulation> simulationOf(const std::string& text) {
  return std::make_unique<Simulation>(setup::simulationSetup(setup::parseScene(text, "scene.toml")), base::cpuExec(1),
                                      [](double, double) {});
}

/// Steps to the time, rounded to a whole step.
inline void advanceTo(Simulation& s, double time) {
  while (s.time() < time - 0.5 * s.timeStep()) s.step();
}

/// State of the bodies of a scene without vehicle.
inline const multibody::State& stateOf(const Simulation& s) { return s.mechanism()->state(); }

} // namespace grouser::coupling

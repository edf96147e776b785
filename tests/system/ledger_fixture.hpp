// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "coupling/simulation.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/runs/shared_cache.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>

/// Scenes with known energy paths.
namespace grouser::coupling::ledgers {

constexpr double kRadius = 0.01, kDensity = 2500, kGravity = 9.81;

inline double ballMass() { return kDensity * 4.0 / 3 * base::kPi * kRadius * kRadius * kRadius; }

inline std::string material(double restitution, double friction, const std::string& more = {}, double stiffness = 1e5) {
  return fmt::format("[material.soil]\ndensity = {}\nstiffness = {}\nrestitution = {}\nfriction = {}\n{}\n", kDensity,
                     stiffness, restitution, friction, more);
}

inline std::string ballAt(const std::string& position, const std::string& motion = {}) {
  return fmt::format("[[grain]]\nposition = {}\n{}\nradius = {}\nmaterial = \"soil\"\n", position, motion, kRadius);
}

inline std::string planeThrough(const std::string& point, const std::string& normal, const std::string& more = {}) {
  return fmt::format("[[plane]]\npoint = {}\nnormal = {}\nmaterial = \"soil\"\n{}\n", point, normal, more);
}

inline std::string oneBall(double height, const std::string& motion) {
  return ballAt(fmt::format("[0, 0, {}]", height), motion) + planeThrough("[0, 0, 0]", "[0, 0, 1]");
}

/// `run`: more keys of that section; double precision without them.
inline scene::Scene sceneOf(const std::string& things, double duration, double step, const std::string& run = {}) {
  return setup::parseScene(fmt::format("version = 1\n[run]\nduration = {}\ntime_step = {}\n{}\n{}", duration, step,
                                       run.empty() ? "precision = \"double\"" : run, things),
                           "ledger.toml");
}

inline std::unique_ptr<Simulation> made(const scene::Scene& scene) {
  return std::make_unique<Simulation>(
      setup::simulationSetup(scene), base::cpuExec(1), [](double, double) {}, base::Comm{}, sharedBeds(),
      sharedSpheres());
}

/// The ledger at the end.
inline Ledger after(const std::string& things, double duration, double step, const std::string& run = {}) {
  const auto simulation = made(sceneOf(things, duration, step, run));
  while (simulation->time() < duration - 0.5 * step) simulation->step();
  return simulation->ledger();
}

} // namespace grouser::coupling::ledgers

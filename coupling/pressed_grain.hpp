// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "coupling/ground_setup.hpp"
#include "terrain/grains.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// The grain that a part has pressed by the greatest share of its radius.
struct PressedMost {
  int part{-1}; ///< among the parts of the results' frames; -1: none has pressed any
  std::uint32_t grain{};
  double share{}; ///< [-]
};

/// A grain that has stopped a run, and what it touches.
struct PressedGrain {
  struct Presser {
    std::string name;   ///< "plane 'lid'"
    double overlap{};   ///< [m]
    base::Vec3d normal; ///< unit, from there to the grain; zero where it is not known
    bool rigid{true};   ///< no grain
  };
  base::Vec3d position, velocity; ///< [m], [m/s]
  double radius{};                ///< [m]
  std::vector<Presser> by;        ///< deepest first

  /// "it is pinched between plane 'lid' (1.2 mm) and plane 0 (1 mm)", of several the deepest two that face each other;
  /// "it is pressed by grain 7 (0.3 mm)", at most three of them; empty where it touches nothing.
  std::string sentence() const;
  /// What is rigid that presses it most; null where nothing is.
  const Presser* rigidPresser() const;
  /// Whether it touches nothing and moves as what falls does. `gravity` [m/s2].
  bool fallsFreely(const base::Vec3d& gravity) const;
};

/// Looks at all grains, walls, the floor and surfaces but meshes for what touches grain `id`: for the end of a run. All
/// ranks call it. `surfacePose`: of surface i now.
PressedGrain pressedGrain(const terrain::Grains& grains, const GroundSetup& setup,
                          const std::function<base::Pose(std::size_t)>& surfacePose, std::uint32_t id);

} // namespace grouser::coupling

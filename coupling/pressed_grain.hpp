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

/// The largest overlap of a grain with a part, as a share of the grain's radius.
struct DeepestPartOverlap {
  int part{-1}; ///< among the parts of the results' frames; -1: no contact
  std::uint32_t grain{};
  double share{}; ///< [-]
};

/// A grain that has stopped a run, and its contacts.
struct PressedGrain {
  struct Presser {
    std::string name;   ///< "plane 'lid'"
    double overlap{};   ///< [m]
    base::Vec3d normal; ///< unit, towards the grain; zero if unknown
    bool rigid{true};   ///< not a grain
  };
  base::Vec3d position, velocity; ///< [m], [m/s]
  double radius{};                ///< [m]
  std::vector<Presser> by;        ///< deepest first

  /// "it is pinched between plane 'lid' (1.2 mm) and plane 0 (1 mm)" for the deepest two contacts that face each other;
  /// else "it is pressed by grain 7 (0.3 mm)" with at most three contacts; empty without contact.
  std::string sentence() const;
  /// The rigid surface with the deepest overlap; null if there is none.
  const Presser* rigidPresser() const;
  /// Whether it has no contact and falls. `gravity` [m/s2].
  bool fallsFreely(const base::Vec3d& gravity) const;
};

/// Finds all contacts of grain `id` with grains, walls, floor and surfaces except meshes: for the end of a run. All
/// ranks call it. `surfacePose`: present pose of surface i.
PressedGrain pressedGrain(const terrain::Grains& grains, const GroundSetup& setup,
                          const std::function<base::Pose(std::size_t)>& surfacePose, std::uint32_t id);

} // namespace grouser::coupling

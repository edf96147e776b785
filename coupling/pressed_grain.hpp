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

/// Deepest overlap of a grain with a part, relative to the grain radius.
struct DeepestPartOverlap {
  int part{-1}; ///< index among the parts in the frames of the results; -1: no contact
  std::uint32_t grain{};
  double share{}; ///< [-]
};

/// Grain that has stopped a run, with its contacts.
struct PressedGrain {
  struct Presser {
    std::string name;   ///< "plane 'lid'"
    double overlap{};   ///< [m]
    base::Vec3d normal; ///< unit, towards the grain; zero if unknown
    bool rigid{true};   ///< false: a grain
  };
  base::Vec3d position, velocity; ///< [m], [m/s]
  double radius{};                ///< [m]
  std::vector<Presser> by;        ///< deepest first

  /// Message "it is pinched between plane 'lid' (1.2 mm) and plane 0 (1 mm)" for the deepest two opposite contacts;
  /// else "it is pressed by grain 7 (0.3 mm)" with at most three contacts; empty without contact.
  std::string sentence() const;
  /// Rigid surface with the deepest overlap; null if there is none.
  const Presser* rigidPresser() const;
  /// True if it has no contact and is in free fall. `gravity` [m/s2].
  bool fallsFreely(const base::Vec3d& gravity) const;
};

/// Finds all contacts of grain `id` with grains, walls, floor and surfaces except meshes, at the end of a run.
/// `surfacePose`: current pose of surface i. Collective.
PressedGrain pressedGrain(const terrain::Grains& grains, const GroundSetup& setup,
                          const std::function<base::Pose(std::size_t)>& surfacePose, std::uint32_t id);

} // namespace grouser::coupling

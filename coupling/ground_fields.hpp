// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "scm/soil_constants.hpp"

#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// A node of deformable soil that has been loaded or moved.
struct SoilNode {
  std::int32_t i{}, j{};
  double sinkage{};     ///< vertical depth of the present surface below the undisturbed one [m]; negative above it
  double pressure{};    ///< [Pa] now, mean over the square of the node
  double maxPressure{}; ///< [Pa] since the start
  base::Vec3d shear;    ///< stress on the soil [Pa] now
};

/// Present deformable soil, for output. All other nodes are undisturbed and unloaded.
struct GroundFields {
  scm::SoilConstants constants;
  double spacing{};            ///< node (i, j) lies at x = i spacing, y = j spacing [m]
  std::vector<SoilNode> nodes; ///< by j, then i
};

} // namespace grouser::coupling

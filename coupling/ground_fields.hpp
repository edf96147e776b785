// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "scm/soil_constants.hpp"

#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// Node of deformable soil that has been loaded or moved.
struct SoilNode {
  std::int32_t i{}, j{};
  double sinkage{};     ///< vertical depth of the current surface below the undisturbed one [m]; negative above it
  double pressure{};    ///< current pressure [Pa], averaged over the node's square
  double maxPressure{}; ///< maximum pressure since the start [Pa]
  base::Vec3d shear;    ///< current shear stress on the soil [Pa]
};

/// Current fields of deformable soil, for output. All other nodes are undisturbed and unloaded.
struct GroundFields {
  scm::SoilConstants constants;
  double spacing{};            ///< node (i, j) is at x = i spacing, y = j spacing [m]
  std::vector<SoilNode> nodes; ///< by j, then i
  double deepest{};            ///< maximum sinkage since the start of any node's virgin loading [m]
};

} // namespace grouser::coupling

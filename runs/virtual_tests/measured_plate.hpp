// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plate_test.hpp"

#include <optional>

/// A circular plate pushed into the bed of a scene's [terrain], for comparison with a measured test.
namespace grouser::virtual_tests {

struct MeasuredPlateTest {
  double diameter = 0;            ///< [m] of the plate
  double sinkage = 0;             ///< [m] final sinkage below the mean surface of the bed
  double bin = 0, depth = 0;      ///< [m] side of the square bed between periodic boundaries, and its depth
  double inertialNumber = 1.8e-3; ///< [-] as in PlateTest
  std::optional<double> porosity; ///< [-] terrain.porosity; without it the bed settles with its own friction

  double speed(const Soil& soil) const; ///< [m/s]
};

/// Columns of a test's table; constant from the third column.
inline const std::vector<std::string> kMeasuredPlateColumns = {"sinkage [m]", "pressure [Pa]", "porosity [-]",
                                                               "depth [m]",   "grains",        "settling friction [-]",
                                                               "steps",       "wall time [s]"};

/// Settles the bed, or takes it from the cache, and pushes the plate, which is as rough as the grains. Throws
/// SimulationError if the run fails, and InputError if the bed cannot reach the porosity.
jobs::Table pushMeasuredPlate(const Soil& soil, const MeasuredPlateTest& test, std::int64_t seed,
                              const std::filesystem::path& folder, const base::Exec& exec, const PlateProgress& tell);

} // namespace grouser::virtual_tests

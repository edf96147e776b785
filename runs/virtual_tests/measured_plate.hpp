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
  std::optional<double> porosity; ///< [-] terrain.porosity; empty: the bed settles with the friction of the soil

  double speed(const Soil& soil) const; ///< [m/s]
};

/// Columns of a test's table; the values from the third column on are the same in all rows.
inline const std::vector<std::string> kMeasuredPlateColumns = {"sinkage [m]", "pressure [Pa]", "porosity [-]",
                                                               "depth [m]",   "grains",        "settling friction [-]",
                                                               "steps",       "wall time [s]"};

/// Settles the bed or reads it from the cache, then pushes the plate, which has the friction of the grains. Throws
/// SimulationError if the run fails, and InputError if the bed cannot reach the porosity.
jobs::Table pushMeasuredPlate(const Soil& soil, const MeasuredPlateTest& test, std::int64_t seed,
                              const std::filesystem::path& folder, const base::Exec& exec, const PlateProgress& report);

} // namespace grouser::virtual_tests

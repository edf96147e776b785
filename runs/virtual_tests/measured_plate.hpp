// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/plan.hpp"

/// A circular plate pushed into a bed as a scene's [terrain] makes it, for comparison with a measured test.
namespace grouser::virtual_tests {

/// Columns of a run's table; from the third on the same in all rows.
inline const std::vector<std::string> kMeasuredPlateColumns = {"sinkage [m]", "pressure [Pa]", "porosity [-]",
                                                               "depth [m]",   "grains",        "settling friction [-]",
                                                               "steps",       "wall time [s]"};

/// Settles the bed, or takes it from the cache, and pushes a plate of `diameter` [m] down to the sinkage that the plan
/// has for it. The plate is as rough as the grains; sinkage counts from the mean surface of the bed. Throws
/// SimulationError where the run fails, and InputError where the bed cannot have the soil's porosity.
jobs::Table pushMeasuredPlate(const TestPlan& plan, double diameter, std::int64_t seed,
                              const std::filesystem::path& folder, const base::Exec& exec, const PlateProgress& tell);

} // namespace grouser::virtual_tests

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/fluid_domain.hpp"
#include "runs/output/channels.hpp"

#include <string>
#include <vector>

namespace grouser::output {

/// Fluid data of one row.
struct FluidReading {
  fluid::FluidTotals totals;
  double mass;                         ///< [kg]
  std::vector<double> probes;          ///< in the order of the scene [Pa], [m]
  std::vector<fluid::BodyLoad> bodies; ///< [N], [N m]
  std::int64_t rebuilds;
};

FluidReading fluidReading(coupling::FluidDomain& fluid);

/// `probes`: those of the scene; `bodies`: names of the bodies in the fluid.
Columns<FluidReading> fluidColumns(const std::vector<coupling::FluidProbePoint>& probes,
                                   const std::vector<std::string>& bodies);

} // namespace grouser::output

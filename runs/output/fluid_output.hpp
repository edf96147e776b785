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
  double mass;                        ///< [kg]
  std::vector<double> probes;         ///< values in the order of the scene [Pa], [m]
  std::vector<fluid::BodyLoad> loads; ///< loads by column of FluidDomain [N], [N m]
  std::int64_t rebuilds;
};

/// `bodies`: bodies in the fluid, or null.
FluidReading fluidReading(coupling::FluidDomain& fluid, const multibody::State* bodies);

/// `probes`: probes of the scene. `loads`: columns of FluidDomain.
Columns<FluidReading> fluidColumns(const std::vector<coupling::FluidProbePoint>& probes,
                                   const std::vector<std::string>& loads);

} // namespace grouser::output

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/validation/studies/vehicle_trial.hpp"

#include <array>
#include <string>
#include <vector>

/// Files of vehicle runs, which are pieces of a study.
namespace grouser::studies {

/// A figure of a run as a table column.
struct FigureColumn {
  const char* name;
  double MapFigures::*value;
};
inline constexpr std::array<FigureColumn, 14> kTrialFigures{{{"speed [m/s]", &MapFigures::speed},
                                                             {"height [m]", &MapFigures::height},
                                                             {"lowest height [m]", &MapFigures::lowest},
                                                             {"pitch [rad]", &MapFigures::pitch},
                                                             {"power [W]", &MapFigures::power},
                                                             {"tension [N]", &MapFigures::tension},
                                                             {"sinkage [m]", &MapFigures::sinkage},
                                                             {"dissipated [J]", &MapFigures::dissipated},
                                                             {"integration error [J]", &MapFigures::integrationError},
                                                             {"turnover [J]", &MapFigures::turnover},
                                                             {"left over [-]", &MapFigures::energyResidual},
                                                             {"speed magnitude [m/s]", &MapFigures::speedMagnitude},
                                                             {"power magnitude [W]", &MapFigures::powerMagnitude},
                                                             {"blow [weights]", &MapFigures::blow}}};

/// Reads the runs of one point or vehicle.
void keepTrials(jobs::Pieces& pieces, const std::string& name, const std::vector<VehicleTrial>& trials);
/// Throws base::InputError if another version wrote the table.
std::vector<VehicleTrial> readTrials(const jobs::Pieces& pieces, const std::string& name);

} // namespace grouser::studies

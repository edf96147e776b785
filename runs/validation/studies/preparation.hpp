// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/estimate.hpp"
#include "runs/jobs/pieces.hpp"

namespace grouser::studies {

struct PreparationCommand {
  jobs::StudyPlace place;
  jobs::PieceOptions pieces;
  std::vector<double> porosities = {0.36, 0.38, 0.40, 0.42, 0.44, 0.46};
  double friction = 0.5, rollingFriction = 0;
  double width = 12, depth = 12; ///< [d] width between periodic boundaries, and depth of the bed
  int seeds = 8;
};
/// `grouser study preparation`
void studyPreparationCommand(const PreparationCommand& command);

/// Columns of a run's table, which has one row.
inline const std::vector<std::string> kPreparationColumns = {
    "wanted [-]", "porosity [-]", "preparation friction [-]", "coordination [-]", "rattlers [-]",
    "order [-]",  "grains"};

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"

#include <string>
#include <vector>

namespace grouser::studies {

/// `grouser study fluid`.
struct FluidCommand {
  jobs::StudyPlace place;
  std::vector<std::string> cases; ///< empty: all
  std::string device = "auto";
  int threads = 1;
};
void studyFluidCommand(const FluidCommand& command);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"

#include <string>
#include <vector>

namespace grouser::studies {

/// `grouser study multibody`.
struct StudyCommand {
  std::vector<std::string> cases; ///< empty: all
  bool stability = false;         ///< only test which steps are stable
  double budget = 60;             ///< maximum CPU time per run [s]
  jobs::StudyPlace place;         ///< quick: few step sizes and few cases
};
void studyMultibodyCommand(const StudyCommand& command);

} // namespace grouser::studies

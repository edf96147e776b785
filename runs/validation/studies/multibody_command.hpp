// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"

#include <string>
#include <vector>

namespace grouser::studies {

/// `grouser study multibody`.
struct StudyCommand {
  std::vector<std::string> cases; ///< empty: all
  bool stability = false;         ///< only which steps are stable
  double budget = 60;             ///< [s] of CPU for one run
  jobs::StudyPlace place;         ///< quick: few steps of a few cases
};
void studyMultibodyCommand(const StudyCommand& command);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/drift.hpp"
#include "runs/validation/studies/touch.hpp"

namespace grouser::studies {

/// `grouser study precision`.
struct PrecisionCommand {
  jobs::StudyPlace place;
  TouchStudy touch;
  DriftStudy drift;
  int threads = 0; ///< number of CPU threads; 0: all
};
void studyPrecisionCommand(const PrecisionCommand& command);

} // namespace grouser::studies

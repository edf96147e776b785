// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/session/run_session.hpp"

namespace grouser::session {

/// Adds the final figures of bed, drive, ground impacts, crushing and large overlaps to the run's summary.
void noteFigures(RunSession& run, output::Summary& summary);

} // namespace grouser::session

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/session/run_session.hpp"

namespace grouser::session {

/// What the summary says of a run's end, whoever has driven it: bed, drive, blows, crushing and squeezed grains.
void noteFigures(RunSession& run, output::Summary& summary);

} // namespace grouser::session

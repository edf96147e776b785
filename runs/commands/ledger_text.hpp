// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::coupling {
class Simulation;
} // namespace grouser::coupling

namespace grouser::commands {

/// Prints the run's energy balance and momenta, with integration error and residuals.
void describeLedger(coupling::Simulation& simulation);

} // namespace grouser::commands

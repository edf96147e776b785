// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::coupling {
class Simulation;
} // namespace grouser::coupling

namespace grouser::commands {

/// Prints the run's energies and momenta, and what finite steps and rounding have made of them.
void describeLedger(coupling::Simulation& simulation);

} // namespace grouser::commands

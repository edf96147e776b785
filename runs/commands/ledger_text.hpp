// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::simulation {
class Simulation;
} // namespace grouser::simulation

namespace grouser::commands {

/// Prints the run's energies and momenta, and what finite steps and rounding have made of them.
void describeLedger(simulation::Simulation& simulation);

} // namespace grouser::commands

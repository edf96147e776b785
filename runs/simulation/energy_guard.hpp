// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "runs/simulation/ledger.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::simulation {

/// What the guard says: the energies are wrong, while the state is still one that could go on.
class EnergyAlarm : public base::SimulationError {
public:
  using SimulationError::SimulationError;
};

/// Judges whether steps are short enough for what happens, by the energy that they make or lose against the energy that
/// has been exchanged since the last look: work on each body in each step, dissipation, and work of drives. It looks at
/// fixed step numbers, so its verdict does not depend on rows of output, devices, batches or ranks.
///
/// Sound runs of grains at their limit step lose up to a tenth and make up to 3 percent in an interval (lost at
/// impacts, whose beginning and end fall between steps). Steps that are too long make a tenth and more, and let
/// dampers, whose force then outlives the motion that it acts against, give energy instead of taking it.
class EnergyGuard {
public:
  static constexpr std::int64_t kInterval = 512; ///< steps between two looks; whole batches of grains alone
  static constexpr double kMostMade = 0.1;       ///< share of the energy exchanged [-]
  static constexpr double kMostLost = 0.5;
  static constexpr double kMostGiven = 0.02; ///< by what dissipates
  /// Share of all energy exchanged so far that is never an alarm [-]: what rests exchanges next to nothing.
  static constexpr double kQuiet = 1e-3;

  /// Share of the energy that bodies and contacts hold that is rounding [-].
  static constexpr double kRounding = 1e-6;

  /// What is wrong since the last look, in words; empty where nothing is. `held`: energy of bodies and contacts [J].
  std::string judge(const Ledger& now, double held) const;
  /// Remembers `now` for the next judgement.
  void look(const Ledger& now);

  std::vector<double> save() const { return {last_.error, last_.turnover, last_.dissipated, last_.driveWork}; }
  /// Throws base::InputError where it is not what save() gave.
  void restore(const std::vector<double>& saved);

private:
  struct Look {
    double error{}, turnover{}, dissipated{}, driveWork{}; ///< [J]
  };
  Look last_;
};

} // namespace grouser::simulation

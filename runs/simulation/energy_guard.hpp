// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/simulation/ledger.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::simulation {

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

  /// Of what springs have taken up or given back that may stand as made or lost, or as taken by dampers [-]: a contact
  /// under the load of others books the loss of its dashpot as if it were alone, which is wrong by gamma dt / 2 of what
  /// its spring takes up, and right again when it lets go. At the limit of stability that is zeta / (2 zeta + sqrt(4
  /// zeta^2 + 1)) of damping ratio zeta, a quarter at most.
  static constexpr double kSpringShare = 0.25;

  /// Share of the energy that bodies and contacts hold that is rounding [-].
  static constexpr double kRounding = 1e-6;

  /// Energies since the last look [J].
  struct Exchange {
    double moved{};       ///< work on bodies, dissipation and work of drives, without signs
    double lost{};        ///< by the steps; negative: made
    double given{};       ///< by dampers and not lost by the steps; negative where they take
    double neverAlarms{}; ///< rounding, what is small beside the whole run, and what springs hide
    /// Of what was exchanged, what counts of `energy` [-].
    double share(double energy) const { return moved > 0 && energy > neverAlarms ? (energy - neverAlarms) / moved : 0; }
  };
  /// `held`: energy of bodies and contacts [J].
  Exchange since(const Ledger& now, double held) const;
  /// What is wrong since the last look, in words; empty where nothing is.
  std::string judge(const Ledger& now, double held) const;
  /// Remembers `now` for the next judgement.
  void look(const Ledger& now);

  std::vector<double> save() const {
    return {last_.error, last_.turnover, last_.dissipated, last_.driveWork, last_.elastic};
  }
  /// Throws base::InputError where it is not what save() gave.
  void restore(const std::vector<double>& saved);

private:
  struct Look {
    double error{}, turnover{}, dissipated{}, driveWork{}, elastic{}; ///< [J]
  };
  Look last_;
};

} // namespace grouser::simulation

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "coupling/ledger.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::coupling {

/// What the guard says: the energies are wrong, while the state is still one that could go on.
class EnergyAlarm : public base::SimulationError {
public:
  explicit EnergyAlarm(const std::string& message) : SimulationError(message, base::Cause::unstableContacts) {}
};

/// Judges whether steps are short enough for what happens, by the energy that they make or lose against the energy that
/// has been exchanged since the last look: work on each body in each step, dissipation, and work of drives. It looks at
/// fixed step numbers, so its verdict does not depend on rows of output, devices, batches or ranks.
///
/// What sound runs make and lose stands in docs/steps.md#energy-ledger. Steps that are too long make a tenth and more,
/// and let dampers, whose force then outlives the motion that it acts against, give energy instead of taking it.
class EnergyGuard {
public:
  static constexpr std::int64_t kInterval = 512;  ///< steps between two looks; whole batches of grains alone
  static constexpr std::int64_t kOneContact = 20; ///< steps of one; nothing is judged over fewer
  // Shares of the energy exchanged [-].
  /// That bodies and springs have gained from nowhere. Where parts of a vehicle touch, of what is really dissipated
  /// too: what steps make in a contact that they do not resolve its dashpot and friction take at once, and however
  /// little that is beside the weight and the speed that a vehicle moves about, what was dissipated is wrong by all of
  /// it.
  static constexpr double kMostMade = 0.1;
  /// Made by the steps, and dissipated at once: sliding contacts of grains that bounce well book up to an eighth so at
  /// their limit step, where the motion is right yet.
  static constexpr double kMostChurned = 0.15;
  static constexpr double kMostLost = 0.3;
  static constexpr double kMostGiven = 0.02; ///< by what dissipates
  /// Share of all energy exchanged so far that is never an alarm [-]: what rests exchanges next to nothing.
  static constexpr double kQuiet = 1e-3;

  /// Of what springs have taken up or given back that may stand as made or lost, or as taken by dampers [-]: a contact
  /// under the load of others books the loss of its dashpot as if it were alone, which is wrong by gamma dt / 2 of what
  /// its spring takes up, and right again when it lets go. At the limit of stability that is zeta / (2 zeta + sqrt(4
  /// zeta^2 + 1)) of damping ratio zeta, a quarter at most. Since the start: of contacts of grains with each other,
  /// floor and walls.
  static constexpr double kSpringShare = 0.25;
  /// Of what parts of a vehicle have dissipated since the start [-], beyond which a bed's springs hide no more than
  /// kBreath of the most that they have held above or below what they began with.
  static constexpr double kMostHidden = 0.25, kBreath = 0.01;

  /// Of the energy that bodies and contacts hold, and of m g radius of all grains [-], that steps may have made since
  /// the start as long as less than that has been dissipated.
  static constexpr double kAtTheStart = 1e-4;

  /// Share that is rounding [-] of the energy that bodies and contacts hold, and of m g radius of all grains: places
  /// have a resolution of 1e-8 of a diameter.
  static constexpr double kRounding = 1e-6;

  /// Energies since the last look [J].
  struct Exchange {
    double moved{};       ///< work on bodies, dissipation and work of drives, without signs
    double lost{};        ///< by the steps; negative: made
    double gained{};      ///< made by the steps and not dissipated; negative: lost
    double given{};       ///< by dampers and not lost by the steps; negative where they take
    double taken{};       ///< dissipated
    double heat{};        ///< the same, but what grains seem to give does not lessen it
    double neverAlarms{}; ///< rounding, what is small beside the whole run, and what springs hide
    /// Of what was exchanged, what counts of `energy` [-].
    double share(double energy) const { return moved > 0 && energy > neverAlarms ? (energy - neverAlarms) / moved : 0; }
  };
  /// `held`: energy of bodies and contacts, and m g radius of all grains [J].
  Exchange since(const Ledger& now, double held) const;
  /// Describes an energy error since the last look; empty if there is none. `implicit`: energy losses are no error.
  std::string judge(const Ledger& now, double held, bool implicit = false) const;
  /// Remembers `now` for the next judgement.
  void look(const Ledger& now);

  std::vector<double> save() const {
    return {last_.error,   last_.turnover, last_.dissipated, last_.driveWork,
            last_.elastic, last_.ofGrains, mostInGrains_};
  }
  /// Throws base::InputError where it is not what save() gave.
  void restore(const std::vector<double>& saved);

private:
  /// What the steps have made of what contacts of parts have dissipated, in words; empty where that is little.
  std::string judgeHeat(const Ledger& now, double held) const;

  struct Look {
    double error{}, turnover{}, dissipated{}, driveWork{}, elastic{}, ofGrains{}; ///< [J]
  };
  Look last_;
  double mostInGrains_ = 0; ///< greatest |Ledger::grainElastic| that was looked at [J]
};

} // namespace grouser::coupling

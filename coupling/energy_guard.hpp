// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "coupling/ledger.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Energy error detected by the guard; the state itself is valid.
class EnergyAlarm : public base::SimulationError {
public:
  explicit EnergyAlarm(const std::string& message) : SimulationError(message, base::Cause::unstableContacts) {}
};

/// Checks that time steps are short enough: compares the energy created or lost by time integration with the energy
/// exchanged since the last check: absolute work on each body in each step, dissipation, and work of drives. It checks
/// at fixed step numbers, so its result does not depend on output rows, devices, batches or ranks.
///
/// docs/steps.md#energy-ledger lists the errors of valid runs. Steps that are too long create a tenth of this energy or
/// more. They also make dampers create energy, since a damper force then outlasts the motion that it opposes.
class EnergyGuard {
public:
  static constexpr std::int64_t kInterval = 512;  ///< steps between two checks; whole batches of pure grain steps
  static constexpr std::int64_t kOneContact = 20; ///< steps per contact; minimum number of steps for a check
  // Thresholds as fractions of the energy exchanged [-].
  /// Energy created in bodies and springs. For contacts of vehicle parts also relative to the true dissipation: energy
  /// created in an unresolved contact is dissipated at once by its dashpot and friction. It is small compared with the
  /// work on the vehicle, but it is an error of the dissipation.
  static constexpr double kMaxMade = 0.1;
  /// Energy created and dissipated at once: sliding contacts of grains with high restitution reach 1/8 at their limit
  /// step, where the motion is still correct.
  static constexpr double kMaxSpuriousDissipation = 0.15;
  static constexpr double kMaxLost = 0.3;
  static constexpr double kMaxGiven = 0.02; ///< energy created by dampers
  /// Fraction of all energy exchanged so far that never raises an alarm [-]: at rest almost nothing is exchanged.
  static constexpr double kQuiet = 1e-3;

  /// Fraction of the energy stored or released by springs that may appear as created, lost, or dissipated [-]. A
  /// contact loaded by others accounts for its dashpot loss as if it were isolated, with an error of gamma dt / 2
  /// times its spring energy until that energy is released. At the stability limit gamma dt / 2 is zeta / (2 zeta +
  /// sqrt(4 zeta^2 + 1)) for damping ratio zeta, at most 1/4. The check since the start includes only the springs of
  /// grain contacts with grains, floor and walls.
  static constexpr double kSpringShare = 0.25;
  /// Fraction of the dissipation of vehicle parts since the start [-] above which springs of a bed may hide at most
  /// kElasticTolerance of the largest change of their elastic energy.
  static constexpr double kMaxHidden = 0.25, kElasticTolerance = 0.01;

  /// Fraction of the energy of bodies and contacts, and of m g radius of all grains [-]. There is no alarm while the
  /// energies created and dissipated since the start are both below it.
  static constexpr double kAtTheStart = 1e-4;

  /// Rounding error as a fraction [-] of the energy of bodies and contacts, and of m g radius of all grains: positions
  /// have a resolution of 1e-8 of a diameter.
  static constexpr double kRounding = 1e-6;

  /// Energies exchanged since the last check [J].
  struct Exchange {
    double moved{};       ///< absolute work on bodies, dissipation and absolute work of drives
    double lost{};        ///< by time integration; negative: created
    double gained{};      ///< created by time integration and not dissipated; negative: lost
    double given{};       ///< created by dampers and not lost by time integration; negative if they dissipate
    double taken{};       ///< dissipated
    double heat{};        ///< as `taken`, without negative dissipation of grains
    double neverAlarms{}; ///< rounding, a small share of all energy exchanged so far, errors hidden by springs
    /// `energy` in excess of neverAlarms / exchanged energy [-].
    double share(double energy) const { return moved > 0 && energy > neverAlarms ? (energy - neverAlarms) / moved : 0; }
  };
  /// Energy that steps with complementarity contacts may create or lose in kInterval steps because their solver stops
  /// at the velocity error `residual` [m/s]: a contact that carries the force F exchanges F h residual per step.
  /// `weight`: of everything that contacts carry [N]; `timeStep`: h [s].
  static double solverError(double weight, double residual, double timeStep) {
    return static_cast<double>(kInterval) * weight * residual * timeStep;
  }

  /// Computes the exchange since the last check. `held`: energy of bodies and contacts + m g radius of all grains [J].
  Exchange since(const Ledger& now, double held) const;
  /// Describes an energy error since the last check; empty if there is none. `implicit`: energy error [J] that the
  /// solver of implicit contacts may cause, which never raises an alarm, see solverError(); energy losses are accepted.
  std::string judge(const Ledger& now, double held, std::optional<double> implicit = {}) const;
  /// Stores `now` as reference of the next check.
  void look(const Ledger& now);

  std::vector<double> save() const {
    return {last_.error,   last_.turnover, last_.dissipated, last_.driveWork,
            last_.elastic, last_.ofGrains, maxInGrains_};
  }
  /// Throws base::InputError if `saved` is not from save().
  void restore(const std::vector<double>& saved);

private:
  /// Describes energy created and dissipated in contacts of parts; empty if it is small. `solver`: see judge() [J].
  std::string judgeHeat(const Ledger& now, double held, double solver) const;

  struct Look {
    double error{}, turnover{}, dissipated{}, driveWork{}, elastic{}, ofGrains{}; ///< [J]
  };
  Look last_;
  double maxInGrains_ = 0; ///< largest |Ledger::grainElastic| at a check [J]
};

} // namespace grouser::coupling

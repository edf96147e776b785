// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/laid_ground.hpp"

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace grouser::coupling {

/// Who watches a bed settle.
struct SettleProgress {
  template <class Tell>
  requires std::invocable<const Tell&, double, double> SettleProgress(Tell f) : tell(std::move(f)) {}
  void operator()(double time, double agitation) const { tell(time, agitation); }

  /// Called now and then: simulated time [s], kinetic energy a grain over m g radius [-].
  std::function<void(double time, double agitation)> tell;
  /// Where it ends in a SimulationError: the bed as it is then, and the message of the error, which is thrown when this
  /// returns. May be empty; must not throw.
  std::function<void(const terrain::Grains& bed, const std::string& message, base::Cause cause)> failed{};
};

/// Frictions that trials have found, kept from run to run.
class FoundFrictions {
public:
  FoundFrictions() = default;
  FoundFrictions(const FoundFrictions&) = delete;
  FoundFrictions& operator=(const FoundFrictions&) = delete;
  virtual ~FoundFrictions() = default;
  /// Empty where none is kept of that origin (PreparationSetup).
  virtual std::optional<double> find(const std::string& origin) const = 0;
  virtual void keep(const std::string& origin, double friction) const = 0;
};

/// How settling ended.
struct SettleReport {
  double time{};      ///< simulated [s]
  double agitation{}; ///< mean kinetic energy a grain over m g radius [-]
  std::int64_t steps{};
  double friction{}; ///< [-] with which the bed was prepared; 0: with its own
  /// Of the bed then: the highest grain's top, and the mean of its surface, as BedStructure has it [m].
  double highest{}, meanHeight{};
};

/// Lets the grains rest as `wanted`: until the mean kinetic energy a grain (of spin too, if wanted) is below that share
/// of m g radius, and the mean resultant force below that share of the weight where one is named, for a whole tenth of
/// a second, but at least for the time that a grain takes to fall `fall` [m]. Adds to `report`. Throws SimulationError
/// when the time limit passes first, or when the grains meet a fault.
void settleUntilRest(const BedSetup& bed, const SettleSetup& wanted, terrain::Grains& grains, double fall,
                     const SettleProgress& progress, SettleReport& report);

/// Lets a loose bed come to rest with `friction` [-] between its grains, under gravity of its strength straight down,
/// and then with their own friction and gravity.
void settleWithFriction(const BedSetup& bed, terrain::Grains& grains, double friction, const SettleProgress& progress,
                        SettleReport& report);

/// Prepares the bed, where the scene asks for a porosity, and lets it come to rest under gravity. Throws
/// SimulationError when the scene's time limit passes first, or when the grains meet a fault: the message says that it
/// was while the bed settled. `found`: see frictionFor().
SettleReport settle(const BedSetup& bed, const LaidGround& ground, const SettleProgress& progress,
                    const FoundFrictions* found = nullptr);

/// The friction that has to act while a bed settles for it to have the porosity wanted: by bisection on small beds,
/// until one is within 0.002 of it. The same on every device and rank. Throws InputError
/// with the porosities that can be reached where the one wanted cannot. `found`: where it is looked up first, and kept;
/// null: nowhere, as on several ranks, each of which does all trials.
double frictionFor(const PreparationSetup& preparation, const base::Exec& exec, const SettleProgress& progress,
                   const FoundFrictions* found = nullptr);

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/laid_ground.hpp"

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace grouser::coupling {

/// Observer of a settling bed.
struct SettleProgress {
  template <class Report>
  requires std::invocable<const Report&, double, double> SettleProgress(Report f) : report(std::move(f)) {}
  void operator()(double time, double energyRatio) const { report(time, energyRatio); }

  /// Called at intervals: simulated time [s], kinetic energy per grain / (m g radius) [-].
  std::function<void(double time, double energyRatio)> report;
  /// Called before a SimulationError is thrown, with the current bed and the message. May be empty; must not throw.
  std::function<void(const terrain::Grains& bed, const std::string& message, base::Cause cause)> failed{};
};

/// Store of frictions determined by trials, for reuse in later runs.
class FoundFrictions {
public:
  FoundFrictions() = default;
  FoundFrictions(const FoundFrictions&) = delete;
  FoundFrictions& operator=(const FoundFrictions&) = delete;
  virtual ~FoundFrictions() = default;
  /// Returns the friction stored for that origin (PreparationSetup); empty if there is none.
  virtual std::optional<double> find(const std::string& origin) const = 0;
  virtual void keep(const std::string& origin, double friction) const = 0;
};

/// Result of settling.
struct SettleReport {
  double time{};        ///< simulated time [s]
  double energyRatio{}; ///< mean kinetic energy per grain / (m g radius) [-]
  std::int64_t steps{};
  double friction{}; ///< friction of the preparation [-]; 0: the material's own
  /// Top of the highest grain, and mean surface height as in BedStructure [m].
  double highest{}, meanHeight{};
};

/// Settles the grains until they satisfy the criteria `wanted` for 0.1 s, but at least for the duration of a free fall
/// by `fall` [m]: the mean kinetic energy per grain (with spin, if wanted) is below its fraction of m g radius, and the
/// mean resultant force, if given, below its fraction of the weight. Adds to `report`. Throws SimulationError after the
/// time limit, or on a fault of the grains.
void settleUntilRest(const BedSetup& bed, const SettleSetup& wanted, terrain::Grains& grains, double fall,
                     const SettleProgress& progress, SettleReport& report);

/// Settles a loose bed with `friction` [-] between its grains under vertical gravity of the same magnitude, and then
/// with their own friction and gravity.
void settleWithFriction(const BedSetup& bed, terrain::Grains& grains, double friction, const SettleProgress& progress,
                        SettleReport& report);

/// Prepares the bed, if the scene specifies a porosity, and settles it under gravity. Throws SimulationError after the
/// scene's time limit, or on a fault of the grains; the message mentions the settling. `found`: see frictionFor().
SettleReport settle(const BedSetup& bed, const LaidGround& ground, const SettleProgress& progress,
                    const FoundFrictions* found = nullptr);

/// Friction during settling that yields the target porosity: by bisection on small beds, to within 0.002. Identical on
/// every device and rank. Throws InputError with the range of porosities if the target is outside. `found`: store of
/// earlier results; null: run all trials (always the case on several ranks, where each rank runs all of them).
double frictionFor(const PreparationSetup& preparation, const base::Exec& exec, const SettleProgress& progress,
                   const FoundFrictions* found = nullptr);

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/neighbour_list.hpp"
#include "contact/subdomain.hpp"
#include "terrain/grain_boundaries.hpp"

#include <chrono>
#include <functional>

namespace grouser::terrain {

using contact::Partition;
using contact::PartitionOptions;
using contact::Subdomain;

/// Distribution of the grains over several ranks: migration across borders, ghosts near borders, and load balancing.
/// Absent on a single rank. All functions not marked `local` are collective, and called in the same order on all ranks.
class GrainDistribution {
public:
  /// `start`: positions of the scene's grains; the initial cuts divide them evenly. Throws InputError if the requested
  /// cuts and subdomains disagree.
  GrainDistribution(const base::Exec& exec, const PartitionOptions& options, const GrainConstants& constants,
                    const std::vector<base::Position>& start);

  const Subdomain& subdomain() const { return subdomain_; }
  Subdomain& subdomain() { return subdomain_; }
  /// Sets the cuts for the next migration; local, but must be equal on all ranks.
  void setPartition(const Partition& partition) { subdomain_.setPartition(partition); }
  /// Postpones load balancing, since loaded grains must stay on the rank that loads them.
  void keepCuts(std::int64_t step) { balancedAt_ = step; }
  /// Callback before grains migrate, in their old slots, with the new rank of the grain in each slot (device array;
  /// Subdomain::kNobody for slaves), so that owners of grain history can migrate it too. One listener only: setting a
  /// second throws std::logic_error.
  using OnMigrate = std::function<void(const std::uint32_t* destination)>;
  void onMigrate(OnMigrate onMigrate);
  /// Adds time [s] spent on work that every rank repeats (the vehicle). Load balancing excludes it, since no cut could
  /// move it to another rank. Local.
  void noteReplicated(double seconds) { replicatedSeconds_ += seconds; }
  std::int64_t rebalancings() const { return rebalancings_; }

  /// Sends every grain to the rank whose subdomain contains its centre, and creates ghosts near the borders. Afterwards
  /// the slots contain the remaining grains, the received grains, and the ghosts, in this order, unsorted.
  void migrate(GrainArrays& arrays, contact::NeighbourList& neighbours, GrainBoundaries& boundaries, std::int64_t step);
  /// Returns the row origins for the next neighbour list; call after migrate() and sorting the arrays by `order`.
  const contact::RowOrigins* sorted(const std::uint32_t* order, GrainArrays& arrays);

  // Halo exchange. The masters' states are packed and sent at the end of step n, and unpacked into the ghosts during
  // step n + 1, while the uniques are computed. Until then a ghost lags one step behind its master.
  void packGhosts(const base::Exec& exec,
                  GrainArrays& arrays); ///< enqueues packing after the masters' step; before swapBuffers()
  void sendGhosts();                    ///< call synchronize() first, so that the device has packed
  /// Waits for the messages of a pending exchange and enqueues unpacking into the ghosts on `exec`.
  void finishGhostUpdate(const base::Exec& exec, GrainArrays& arrays);
  /// Complete halo exchange of the masters' current states.
  void updateGhosts(GrainArrays& arrays);

  std::size_t bytes() const { return subdomain_.bytes() + arrivedRows_.bytes(); }

private:
  void rebalance(const GrainArrays& arrays, std::int64_t step);
  contact::TravellingRows exportRows(const contact::NeighbourList& neighbours, base::Array<std::uint32_t>& leaving);
  void moveFields(GrainArrays& arrays, GrainBoundaries& boundaries, const contact::TravellingRows& leaving);
  void noteOrigins(std::uint32_t owned, std::uint32_t former, GrainArrays& arrays);

  using Clock = std::chrono::steady_clock;

  base::Exec exec_;
  bool rebalances_;
  int historyWidth_;
  Subdomain subdomain_;
  OnMigrate onMigrate_;
  base::Array<std::uint32_t> arrivedRows_; ///< neighbour list rows received with their grains
  contact::RowOrigins origins_{};
  Clock::time_point measuredFrom_{Clock::now()};
  double waitedBefore_{0}, replicatedSeconds_{0};
  std::int64_t balancedAt_{0}, rebalancings_{0};
};

} // namespace grouser::terrain

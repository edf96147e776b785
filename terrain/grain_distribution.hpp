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

/// The grains on several ranks: migration across borders, ghosts near borders, and load balancing. Absent on one rank.
/// All ranks call every function that is not marked `local`, in the same order.
class GrainDistribution {
public:
  /// `start`: positions of the scene's grains; the first cuts divide them evenly. Throws InputError if the requested
  /// cuts and subdomains disagree.
  GrainDistribution(const base::Exec& exec, const PartitionOptions& options, const GrainConstants& constants,
                    const std::vector<base::Position>& start);

  const Subdomain& subdomain() const { return subdomain_; }
  Subdomain& subdomain() { return subdomain_; }
  /// Cuts for the next migration; local, but the same on all ranks.
  void setPartition(const Partition& partition) { subdomain_.setPartition(partition); }
  /// Keeps the cuts for a while: loaded grains must stay with the rank that loads them.
  void keepCuts(std::int64_t step) { balancedAt_ = step; }
  /// Called before grains migrate, in their old slots, with the new rank of the grain in each slot (device array;
  /// Subdomain::kNobody for slaves), so that owners of grain history can send it too. One listener: throws
  /// std::logic_error if there already is one.
  using OnMigrate = std::function<void(const std::uint32_t* destination)>;
  void onMigrate(OnMigrate onMigrate);
  /// Adds time [s] that this rank spent on work that every rank repeats (the vehicle): the load balance leaves it out,
  /// since no cut could move it to another rank. Local.
  void noteReplicated(double seconds) { replicatedSeconds_ += seconds; }
  std::int64_t rebalancings() const { return rebalancings_; }

  /// Sends every grain to the rank whose subdomain holds its centre, and makes ghosts of those near the borders.
  /// Afterwards the slots hold the grains that stayed, those that came, and the ghosts, in this order, not yet sorted.
  void migrate(GrainArrays& arrays, contact::NeighbourList& neighbours, GrainBoundaries& boundaries, std::int64_t step);
  /// After migrate(), once the arrays are sorted by `order`: where the rows of the next neighbour list come from.
  const contact::RowOrigins* sorted(const std::uint32_t* order, GrainArrays& arrays);

  // The halo exchange. The masters' states after step n are packed and sent at its end, and unpacked into the ghosts
  // during step n + 1, while the uniques are computed. Until then a ghost is a step behind its master.
  void packGhosts(const base::Exec& exec,
                  GrainArrays& arrays); ///< queues it behind the masters' step; before swapBuffers()
  void sendGhosts();                    ///< after the device has packed: call synchronize() first
  /// If an exchange is under way: waits for its messages and queues its unpacking into the ghosts on `exec`.
  void finishGhostUpdate(const base::Exec& exec, GrainArrays& arrays);
  /// Complete halo exchange of the masters' present states.
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
  base::Array<std::uint32_t> arrivedRows_; ///< of the neighbour list, with the grains that came
  contact::RowOrigins origins_{};
  Clock::time_point measuredFrom_{Clock::now()};
  double waitedBefore_{0}, replicatedSeconds_{0};
  std::int64_t balancedAt_{0}, rebalancings_{0};
};

} // namespace grouser::terrain

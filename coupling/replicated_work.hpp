// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_distribution.hpp"

#include <chrono>

namespace grouser::coupling {

/// Runs work that every rank repeats (bodies and track of the vehicle) and reports its duration, which the load balance
/// subtracts from the rank's busy time: no cut between subdomains could move such work. On one rank it only runs it.
class ReplicatedWork {
public:
  ReplicatedWork() = default;
  /// `ranks`: of the grains, must outlive it; null on one rank.
  explicit ReplicatedWork(terrain::GrainDistribution* ranks) : ranks_(ranks) {}

  template <class Work> void run(const Work& work) const {
    if (!ranks_) return work();
    const auto start = std::chrono::steady_clock::now();
    work();
    ranks_->noteReplicated(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

private:
  terrain::GrainDistribution* ranks_{nullptr}; ///< null on one rank
};

} // namespace grouser::coupling

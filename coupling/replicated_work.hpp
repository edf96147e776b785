// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_distribution.hpp"

#include <chrono>

namespace grouser::coupling {

/// Runs work that every rank repeats (bodies and track of the vehicle) and reports its duration. Load balancing
/// subtracts this from the rank's busy time, since no cut can move such work. On a single rank it only runs the work.
class ReplicatedWork {
public:
  ReplicatedWork() = default;
  /// `ranks`: distribution of the grains, must outlive this object; null on a single rank.
  explicit ReplicatedWork(terrain::GrainDistribution* ranks) : ranks_(ranks) {}

  template <class Work> void run(const Work& work) const {
    if (!ranks_) return work();
    const auto start = std::chrono::steady_clock::now();
    work();
    ranks_->noteReplicated(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

private:
  terrain::GrainDistribution* ranks_{nullptr}; ///< null on a single rank
};

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/peer_memory.hpp"

#include <cstdint>

namespace grouser::base {

/// An all-reduce of two words, and a barrier, among GPUs that see each other's memory: a kernel in the stream of each,
/// without host or MPI. Each writes its words into the memory of all others and spins on its own until theirs are
/// there.
///
/// All ranks construct and destroy it in the same order, and run it equally often.
class PeerReduction {
public:
  PeerReduction(const Exec& exec, const Comm& comm, PeerUse use);

  /// True if all ranks can access each other and each has its own GPU (with PeerUse::always GPUs may be shared), up to
  /// the maximum number of ranks.
  bool possible() const { return possible_; }
  /// words[0] becomes the least of all ranks', words[1] the union of their bits; two words on the device. Work queued
  /// after it starts only when what was queued before it has ended on all ranks, and its writes are visible to all.
  void run(const Exec& exec, std::uint64_t* words);
  /// Time that this rank's GPU has spent waiting for others since the start [s]. Waits for the work of the Exec.
  double waited() const;

private:
  Exec exec_;
  PeerMemory memory_;
  int rank_, size_;
  bool possible_;
};

} // namespace grouser::base

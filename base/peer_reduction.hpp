// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/peer_memory.hpp"

#include <cstdint>

namespace grouser::base {

/// All-reduce of two words, which is also a barrier, among GPUs with peer access: a kernel in each GPU's stream,
/// without host or MPI. Each GPU writes its words to the memory of all other GPUs and spins on its own memory until the
/// words of the others arrive.
///
/// All ranks must construct and destroy reductions in the same order, and call run() equally often.
class PeerReduction {
public:
  PeerReduction(const Exec& exec, const Comm& comm, PeerUse use);

  /// True if all ranks can access each other's memory, each has its own GPU (PeerUse::always permits shared GPUs), and
  /// the maximum number of ranks is not exceeded.
  bool possible() const { return possible_; }
  /// Reduces two device words over all ranks: words[0] to the minimum, words[1] to the bitwise OR. Work queued after
  /// this call starts once all ranks have finished their earlier work, and sees the writes of that work.
  void run(const Exec& exec, std::uint64_t* words);
  /// Time this rank's GPU has waited for other ranks since the start [s]. Waits for queued work of the Exec.
  double waited() const;

private:
  Exec exec_;
  PeerMemory memory_;
  int rank_, size_;
  bool possible_;
};

} // namespace grouser::base

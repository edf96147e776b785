// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/peer_memory.hpp"

#include <cstdint>

namespace grouser::base {

/// A decision of all ranks that their GPUs take among themselves, in the order of their streams, while no host waits:
/// each writes its words into the memory of all others and looks at its own until theirs are there.
///
/// All ranks construct and destroy it in the same order, and run it equally often.
class PeerReduction {
public:
  PeerReduction(const Exec& exec, const Comm& comm, PeerUse use);

  /// All ranks see each other and have a GPU each (with PeerUse::always, sharing is allowed), and they are not too
  /// many.
  bool possible() const { return possible_; }
  /// words[0] becomes the least of all ranks', words[1] the union of their bits; two words on the device. What the
  /// GPUs have been given before is done on all of them, and seen by all, when what is given afterwards begins.
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

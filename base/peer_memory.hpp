// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/enum_words.hpp"
#include "base/exec.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace grouser::base {

/// Policy for direct access to the memory of other ranks on the same machine.
enum class PeerUse {
  never,
  automatic, ///< for GPUs that support it
  always     ///< InputError if unsupported; also for CPUs, and for PeerReduction among ranks on one GPU
};

template <> struct EnumWords<PeerUse> {
  static constexpr EnumWord<PeerUse> list[] = {
      {PeerUse::automatic, "auto"}, {PeerUse::never, "never"}, {PeerUse::always, "always"}};
};

/// Device memory of this rank with mappings of the other ranks' memory: the GPUs of one machine access each other's
/// memory (CUDA IPC) without host or MPI. Access is tested at run time; without access, only the rank's own memory is
/// mapped. CPUs share memory only on request, since MPI messages are equally fast.
///
/// All members not marked `local` are collective, including the destructor: call them in the same order on all ranks.
class PeerMemory {
public:
  /// Allocates `bytes` of zeroed memory, the same size on all ranks.
  PeerMemory(const Exec& exec, const Comm& comm, PeerUse use, std::size_t bytes = 0);
  PeerMemory(const PeerMemory&) = delete;
  PeerMemory& operator=(const PeerMemory&) = delete;
  ~PeerMemory();

  /// Ensures room for `bytes`, the same on all ranks. Growing adds a quarter, zeroes the memory and waits for the
  /// devices of all ranks, so that no peer reads freed memory.
  void reserve(std::size_t bytes);

  std::size_t size() const { return size_; } ///< bytes; local, equal on all ranks
  void* own() const { return own_; }         ///< local
  /// True if peer access was requested; local, equal on all ranks.
  bool shares() const { return shares_; }
  /// Memory of another rank, or null if not accessible; local. Access is mutual.
  void* of(int rank) const { return views_[static_cast<std::size_t>(rank)]; }
  bool seesAny() const {
    return std::any_of(views_.begin(), views_.end(), [](const void* view) { return view; });
  }
  bool allSeeAll() const { return allSeeAll_; }       ///< local, equal on all ranks
  bool deviceShared() const { return deviceShared_; } ///< some ranks share a GPU; local, equal on all ranks

private:
  void allocate(std::size_t bytes);
  void release() noexcept;
  void checkUse();
  void share(int file);
  static void* opened(const void* handle);
  void close(int rank) noexcept;
  void closeAll() noexcept;
  std::vector<bool> tryViews() const;

  Exec exec_;
  Comm comm_;
  PeerUse use_;
  bool shares_; ///< equal on all ranks
  bool ownIsShared_{false};
  void* own_{nullptr};
  std::size_t size_{0};
  std::vector<void*> views_; ///< by rank
  bool allSeeAll_{false}, deviceShared_{false};
};

} // namespace grouser::base

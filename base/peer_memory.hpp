// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/enum_words.hpp"
#include "base/exec.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace grouser::base {

/// Use of direct access to the memory of other ranks on one machine.
enum class PeerUse {
  never,
  automatic, ///< GPUs, where supported
  always     ///< InputError if unsupported; CPUs too, and PeerReduction also among ranks that share one GPU
};

template <> struct EnumWords<PeerUse> {
  static constexpr EnumWord<PeerUse> list[] = {
      {PeerUse::automatic, "auto"}, {PeerUse::never, "never"}, {PeerUse::always, "always"}};
};

/// Device memory of this rank, and mappings of the other ranks' memory: GPUs of one machine read and write each other's
/// memory (CUDA IPC), without host or MPI. Access is tested, not assumed; without it a rank has only its own memory.
/// CPUs share memory only on request: messages are as fast there.
///
/// All ranks call everything that is not marked `local`, the destructor too, in the same order.
class PeerMemory {
public:
  /// Room for `bytes`, the same on all ranks; zero.
  PeerMemory(const Exec& exec, const Comm& comm, PeerUse use, std::size_t bytes = 0);
  PeerMemory(const PeerMemory&) = delete;
  PeerMemory& operator=(const PeerMemory&) = delete;
  ~PeerMemory();

  /// Room for `bytes`, the same on all ranks, and a quarter more where it has to grow; it is zero then. Where it grows,
  /// waits for the devices of all ranks, so that no peer still reads the memory that is freed.
  void reserve(std::size_t bytes);

  std::size_t size() const { return size_; } ///< bytes; local, on all ranks the same
  void* own() const { return own_; }         ///< local
  /// Peer access was requested; local, on all ranks the same.
  bool shares() const { return shares_; }
  /// The memory of another rank, or null; local. Access is mutual.
  void* of(int rank) const { return views_[static_cast<std::size_t>(rank)]; }
  bool seesAny() const {
    return std::any_of(views_.begin(), views_.end(), [](const void* view) { return view; });
  }
  bool allSeeAll() const { return allSeeAll_; }       ///< local, on all ranks the same
  bool deviceShared() const { return deviceShared_; } ///< some ranks have the same GPU; local, on all ranks the same

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
  bool shares_; ///< on all ranks the same
  bool ownIsShared_{false};
  void* own_{nullptr};
  std::size_t size_{0};
  std::vector<void*> views_; ///< by rank
  bool allSeeAll_{false}, deviceShared_{false};
};

} // namespace grouser::base

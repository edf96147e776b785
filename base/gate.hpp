// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/carry.hpp"

namespace grouser::base {

/// Synchronises the host with device work that is launched before its data are ready, in order to hide the launch
/// latency. The work waits on the device for the host and reports its progress. A run may wait at the gate while the
/// previous run is still in progress.
///
/// While a run waits, no thread may make a call that waits for all device work, such as freeing pinned memory.
///
/// On a CPU nothing is launched ahead: the gate is always open and all queued work is complete.
class Gate {
public:
  Gate() = default;
  explicit Gate(const Exec& exec);
  /// True on a GPU, unless CUDA_LAUNCH_BLOCKING=1 makes every launch synchronous. Set this variable also for profilers
  /// that serialise kernels.
  static bool canWait(const Exec& exec);

  /// Progress marks of the work.
  enum Mark : int { kFirst, kSecond };

  // Device side: enqueue each call once per run; `exec` may be a side stream.
  /// Copies `parcels` as carry() does, without waiting; has no effect if `watch` cancels the run.
  void carryBefore(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels);
  /// Waits until the calls of open() outnumber the runs that have passed, then copies `parcels`. If `watch` cancels the
  /// run, returns without waiting or copying.
  void pass(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels);
  /// Copies `parcels` and releases await(mark) for this run; has no effect if the run is cancelled.
  void signal(const Exec& exec, Mark mark, std::span<const Parcel> parcels);
  /// Device word, valid after pass(): nonzero if this run is cancelled and must not change any state.
  const std::uint32_t* calledOff() const;

  // Host side.
  /// Lets one run pass; the run sees all earlier host writes.
  void open();
  /// Spins until the latest run that passed has reached the mark. Throws DeviceError if the device has failed.
  void await(Mark mark);
  /// Cancels the run that is waiting, will wait, or has passed without reaching its mark; then waits for the device and
  /// resets the gate. Call it before the gate is destroyed during a run; otherwise the destructor deadlocks.
  void callOff();

private:
  /// Pinned host word in its own cache line, since the device reads and writes it concurrently.
  struct alignas(64) Word {
    std::uint64_t value;
  };
  /// Device-side counters.
  struct Passed {
    std::uint64_t runs;
    std::uint64_t signalled[2];
    std::uint32_t off, unused;
  };
  static constexpr std::uint64_t kCalledOff = ~std::uint64_t{0};

  Exec exec_{};
  Mirrored<Word> words_; ///< opened, reached marks (two); the device side is unused
  Array<Passed> passed_;
  std::uint64_t opened_{0};
};

} // namespace grouser::base

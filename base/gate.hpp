// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/carry.hpp"

namespace grouser::base {

/// Synchronises work that is launched ahead of its data with the host: it waits on the device for the host and reports
/// its progress, so that neither waits for a launch. One run may wait at the gate while the previous one is still
/// running.
///
/// While a run waits, no thread may call what waits for all device work, such as the release of pinned memory.
///
/// On a CPU nothing is launched ahead: the gate is always open and queued work is complete.
class Gate {
public:
  Gate() = default;
  explicit Gate(const Exec& exec);
  /// True on a GPU, unless CUDA_LAUNCH_BLOCKING=1 makes each launch wait for its end. Set that under profilers that
  /// serialise kernels, too.
  static bool canWait(const Exec& exec);

  /// Progress marks of the work.
  enum Mark : int { kFirst, kSecond };

  // Device side: queue each once per run; `exec` may be a side stream.
  /// Sets `parcels` as carry() does, without waiting; does nothing if `watch` cancels the run.
  void carryBefore(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels);
  /// Waits until open() has been called once more than runs have passed, then sets `parcels`. If `watch` cancels the
  /// run, it neither waits nor sets anything.
  void pass(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels);
  /// Sets `parcels` and lets await(mark) of this run return; does nothing if the run is cancelled.
  void tell(const Exec& exec, Mark mark, std::span<const Parcel> parcels);
  /// Device word, valid after pass(): nonzero if this run is cancelled and must change nothing.
  const std::uint32_t* calledOff() const;

  // Host side.
  /// Lets one run pass; it sees everything the host has written before.
  void open();
  /// Spins until the run that passed last has reached the mark. Throws DeviceError when the device has failed.
  void await(Mark mark);
  /// Cancels the run that waits, will wait, or has been let through but has not arrived; waits for the device and
  /// resets. Required before the gate is destroyed during a run, which would deadlock.
  void callOff();

private:
  /// Pinned host word in its own cache line, since the device reads and writes it concurrently.
  struct alignas(64) Word {
    std::uint64_t value;
  };
  /// Device-side counters.
  struct Passed {
    std::uint64_t runs;
    std::uint64_t told[2];
    std::uint32_t off, unused;
  };
  static constexpr std::uint64_t kCalledOff = ~std::uint64_t{0};

  Exec exec_{};
  Mirrored<Word> words_; ///< opened, reached marks (two); its device side is unused
  Array<Passed> passed_;
  std::uint64_t opened_{0};
};

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/carry.hpp"

namespace grouser::base {

/// Where work that is launched ahead of its data waits on the device for the host, and tells the host how far it is: so
/// that neither waits for a launch. One run of that work may wait at the gate while the one before it is not over yet.
///
/// While a run waits no thread may ask the device for what waits for all of its work, as the release of pinned memory
/// does.
///
/// On a CPU nothing is launched ahead: the gate is always open, and whatever has been queued is done.
class Gate {
public:
  Gate() = default;
  explicit Gate(const Exec& exec);
  /// Whether work can wait at gates: on a GPU, but where CUDA_LAUNCH_BLOCKING=1 makes each launch wait for its end. To
  /// be set under profilers that run one kernel at a time, too.
  static bool canWait(const Exec& exec);

  /// What the work tells of.
  enum Mark : int { kFirst, kSecond };

  // Queued on the device, once each in every run; `exec` may be a side stream.
  /// Sets `parcels` as carry() does, and does not wait; where `watch` calls the run off, nothing.
  void carryBefore(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels);
  /// Waits until open() has been called once more than runs have passed, then sets `parcels`. Where `watch` calls the
  /// run off it waits for nobody and sets nothing.
  void pass(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels);
  /// Sets `parcels`, and then await(mark) of this run returns; nothing where the run has been called off.
  void tell(const Exec& exec, Mark mark, std::span<const Parcel> parcels);
  /// On the device, behind pass(): not 0 where this run has been called off, and must change nothing.
  const std::uint32_t* calledOff() const;

  // By the host.
  /// Lets one run pass, which sees all that the host has written before.
  void open();
  /// Spins until the run that was let through last has told. Throws DeviceError when the device has failed.
  void await(Mark mark);
  /// Calls off the run that waits, will wait, or has been let through and is not there yet; waits for the device, and
  /// begins anew. Before the gate is destroyed while a run is under way, which would wait for ever.
  void callOff();

private:
  /// On the host, pinned; each word in a cache line of its own, since the device reads and writes them meanwhile.
  struct alignas(64) Word {
    std::uint64_t value;
  };
  /// On the device.
  struct Passed {
    std::uint64_t runs;
    std::uint64_t told[2];
    std::uint32_t off, unused;
  };
  static constexpr std::uint64_t kCalledOff = ~std::uint64_t{0};

  Exec exec_{};
  Mirrored<Word> words_; ///< opened, told (two); of its device side nothing is used
  Array<Passed> passed_;
  std::uint64_t opened_{0};
};

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "contact/patch_buffers.hpp"
#include "contact/patch_lanes.hpp"

#include <cstdint>
#include <vector>

namespace grouser::contact {

/// Contact patches computed on the host, with their tangential springs. Single-threaded. Each patch is pressed at most
/// once per step; the order does not affect the result.
class HostPatches {
public:
  HostPatches(const PatchQuanta& quanta, double timeStep, std::size_t patches)
      : quanta_(quanta), timeStep_(timeStep), states_(patches), lastStep_(patches) {}

  void beginStep();
  /// Adds pressure and friction of one patch to the loads of A and B (`b` < 0: no body B). `pressure`: in world axes,
  /// about A's centre of mass.
  void press(std::size_t patch, const PatchLaw& law, const PartMotion* motion, int a, int b,
             const PatchPressure& pressure, PartLoad* loads);
  /// Ends contacts that were not pressed in this step.
  void endStep();

  double timeStep() const { return timeStep_; }
  PatchBuffers::Ledger ledger() const;
  SavedPatches save() const;
  /// Throws InputError if the state belongs to other patches.
  void restore(const SavedPatches& saved);

private:
  PatchQuanta quanta_;
  double timeStep_;
  std::vector<PatchState> states_;
  std::vector<std::uint64_t> lastStep_;            ///< [patch] value of count_ at its last press
  std::vector<std::uint32_t> pressed_, hadSpring_; ///< patches pressed in this step; in the previous step
  std::uint64_t count_{0};
  std::int64_t elastic_{0}; ///< elastic energy of this step, in quanta
};

} // namespace grouser::contact

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/position.hpp"
#include "terrain/kept_remainder.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// All of the grains on which later bits or later output depend, by id: what a checkpoint holds and a hash is taken of.
/// Free of slots, devices and list layouts. Lists themselves are left out; they can be built anew.
struct GrainState {
  std::vector<base::Position> position;  ///< [count]
  std::vector<base::Vec3f> velocity;     ///< [count] [m/s]
  std::vector<base::Vec3f> spin;         ///< [count] [rad/s]
  std::vector<Remainders> remainders;    ///< [count]
  std::vector<double> dissipated;        ///< [count] since the start [J]; empty without a ledger
  std::vector<std::uint32_t> wallBits;   ///< [count] bit a wall or floor in touch; empty without them
  std::vector<base::Vec3f> wallShear;    ///< [walls and floor][count] [m], zero out of touch; empty without friction
  std::vector<std::uint32_t> contacts;   ///< [count] neighbours in touch
  std::vector<std::uint32_t> neighbour;  ///< ids of those, ascending for each grain, grain by grain
  std::vector<base::Vec3f> contactShear; ///< [m], one a neighbour; empty without friction

  // When the neighbour list was built, so that a resumed run builds the next one at the same step.
  std::vector<base::Vec3<std::uint32_t>> travelled; ///< [count] since then [units], as wrapping words
  double skin{};                                    ///< [-] share of the radius
  std::int64_t rebuilds{};

  /// For the hash: what the next step depends on, grain by grain.
  std::vector<std::uint32_t> words() const;
};

} // namespace grouser::terrain

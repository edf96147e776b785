// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/assembly.hpp"

#include <vector>

namespace grouser::vehicle {

/// Reaction of a pin joint in the last step: action of the shoe behind the pin on the shoe ahead of it.
struct PinReaction {
  double tension = 0; ///< pull along the chain: along the bisector of the x axes of both shoes; < 0: push [N]
  double lateral = 0; ///< force along the pin, left positive [N]
  double bending = 0; ///< moment across the pin, magnitude [N m]
  base::Vec3d force;  ///< whole force, world components [N]
  base::Vec3d moment; ///< moment about the middle of the pin, world components [N m]
};

/// Reactions of the pins of a track in the last step, of length `step` [s]; pin i is ahead of shoe i.
///
/// A closed chain on parallel pins has three states of self-stress: every pin may transmit the same wrench (a force f
/// along the pins and a moment m across them) without any effect on the motion. The model makes the chain statically
/// determinate (Assembly), so that its solution contains one of these states; its size has a pole whenever the axis
/// released by the universal joint points at the spherical joint. Real pins share it by their compliance. This function
/// therefore returns the reactions of least norm, those of equal bearings at both edges of every pad:
///
///   minimise over f, m:  sum over pins i of |F_i + f n|^2 + |M_i + m + f a_i|^2 / L^2,     a_i = (c - p_i) x n
///
/// with the direction n and the positions p_i of the pins, their mean c, and half the pad width L. As the sum of the
/// a_i is zero, f and m follow separately. Tension does not depend on f and m.
std::vector<PinReaction> pinReactions(const Assembly& vehicle, int track, const multibody::State& state, double step);

} // namespace grouser::vehicle

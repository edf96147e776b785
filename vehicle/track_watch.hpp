// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"

#include <string>

namespace grouser::vehicle {

/// The shoe that is farthest from its track's plane.
struct SidewaysShoe {
  int shoe{};     ///< of the track, in the order of the wrap
  double shift{}; ///< of its middle [m]; NaN where a pose is no number
};
SidewaysShoe mostSideways(const Assembly& vehicle, int track, const multibody::State& state);

/// The road wheel that is farthest off the plates under it.
struct LiftedWheel {
  int wheel{};  ///< of the track, rearmost first
  double gap{}; ///< square to the hull [m]
};
LiftedWheel mostLifted(const Assembly& vehicle, int track, const multibody::State& state);

/// The body, of sprocket, idler, road wheels and rollers, about which the loop of a track no longer runs: its axle is
/// not within the polygon of the pins, seen along the axles. -1 while all are.
int outsideLoop(const Assembly& vehicle, int track, const multibody::State& state);

/// How a track has been thrown: which, which part, how far, and what to do; empty while it has not. A shoe may stand
/// beside its wheels by a horn's height, a road wheel may stand off its plates by `lift` [m], and the loop runs around
/// all that it was wrapped on.
std::string thrownTrack(const Assembly& vehicle, int track, const multibody::State& state, double lift);

} // namespace grouser::vehicle

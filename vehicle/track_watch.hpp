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

/// A wheel whose disc, not the gap between its two, the horns below it would come down on.
struct UnguidedWheel {
  int body{-1};    ///< of road wheels and rollers; -1 where all are guided
  double gap{};    ///< between its rim and the plates, square to them [m]
  double beside{}; ///< of its middle to that of the horns, along its axle [m]
};

/// The first wheel that stands off its plates by more than `lift` [m], so that no horn reaches between its discs, while
/// these horns are beside it by more than half of their height: they cannot come back. A track that hangs off its
/// wheels in its plane is guided, however far: it is slack, or lifted by an edge, and lies down again.
UnguidedWheel unguidedWheel(const Assembly& vehicle, int track, const multibody::State& state, double lift);

/// The body, of sprocket, idler, road wheels and rollers, about which the loop of a track no longer runs: its axle is
/// not within the polygon of the pins, seen along the axles. -1 while all are.
int outsideLoop(const Assembly& vehicle, int track, const multibody::State& state);

/// How a track has been thrown: which, which part, how far, and what to do; empty while it has not. A shoe may stand
/// beside its wheels by a horn's height, by half of it where the plates are off a wheel by more than `lift` [m], and
/// the loop runs around all that it was wrapped on. Lift alone is no cause.
std::string thrownTrack(const Assembly& vehicle, int track, const multibody::State& state, double lift);

} // namespace grouser::vehicle

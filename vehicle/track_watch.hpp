// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"

#include <string>

namespace grouser::vehicle {

/// The shoe that is farthest from its track's plane.
struct SidewaysShoe {
  int shoe{};     ///< of the track, in the order of the wrap
  double shift{}; ///< of its middle [m]; NaN if a pose is NaN
};
SidewaysShoe mostSideways(const Assembly& vehicle, int track, const multibody::State& state);

/// The road wheel that is farthest off the plates under it.
struct LiftedWheel {
  int wheel{};  ///< of the track, rearmost first
  double gap{}; ///< normal to the hull [m]
};
LiftedWheel mostLifted(const Assembly& vehicle, int track, const multibody::State& state);

/// A wheel with a disc, instead of the gap between its discs, above the horns.
struct UnguidedWheel {
  int body{-1};    ///< of road wheels and rollers; -1 where all are guided
  double gap{};    ///< between its rim and the plates, normal to them [m]
  double beside{}; ///< distance from its middle to that of the horns, along its axle [m]
};

/// The first wheel that is off its plates by more than `lift` [m], so that no horn reaches between its discs, with
/// these horns beside it by more than half of their height: they cannot return. A track off its wheels within its plane
/// remains guided at any distance: it is slack, or lifted by an edge, and comes down again.
UnguidedWheel unguidedWheel(const Assembly& vehicle, int track, const multibody::State& state, double lift);

/// Body of the sprocket, idler, road wheel or roller that is outside the track loop: its axle is not within the polygon
/// of the pins, seen along the axles. -1 if none.
int outsideLoop(const Assembly& vehicle, int track, const multibody::State& state);

/// Message for a thrown track: side, part, distance and remedy; empty if not thrown. A track is thrown if a shoe is
/// beside its wheels by more than a horn's height, or half of it where the plates are off a wheel by more than `lift`
/// [m], or if the loop does not enclose all its wheels. Lift alone does not count.
std::string thrownTrack(const Assembly& vehicle, int track, const multibody::State& state, double lift);

} // namespace grouser::vehicle

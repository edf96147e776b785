// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multibody/state.hpp"
#include "vehicle/assembly.hpp"

#include <string>

namespace grouser::vehicle {

/// Shoe with the largest lateral distance from its track plane.
struct SidewaysShoe {
  int shoe{};     ///< shoe index in the track, in the order of the wrap
  double shift{}; ///< lateral shift of its middle [m]; NaN if a pose is NaN
};
SidewaysShoe maxLateralShift(const Assembly& vehicle, int track, const multibody::State& state);

/// Road wheel with the largest gap to the plates under it.
struct LiftedWheel {
  int wheel{};  ///< wheel index in the track, rearmost first
  double gap{}; ///< gap normal to the hull [m]
};
LiftedWheel maxLifted(const Assembly& vehicle, int track, const multibody::State& state);

/// Wheel with a disc above the horns; the horns of a guided wheel are between its discs.
struct UnguidedWheel {
  int body{-1};    ///< body of the road wheel or roller; -1 if all are guided
  double gap{};    ///< gap between the rim and the plates, normal to the plates [m]
  double beside{}; ///< lateral distance between the middle of the wheel and of the horns [m]
};

/// Returns the first wheel that is off its plates by more than `lift` [m], so that no horn reaches between its discs,
/// if the horns are also displaced laterally by more than half of their height and cannot return. A track that is off
/// its wheels within its own plane (slack, or lifted by an edge) is still guided and will return.
UnguidedWheel unguidedWheel(const Assembly& vehicle, int track, const multibody::State& state, double lift);

/// Body of a sprocket, idler, road wheel or roller that is outside the track loop, i.e. the pin polygon seen along the
/// axles does not enclose its axle. -1 if there is none.
int outsideLoop(const Assembly& vehicle, int track, const multibody::State& state);

/// Message for a thrown track with side, part, distance and remedy; empty if not thrown. A track is thrown if a shoe is
/// displaced laterally by more than a horn's height (half of it if the plates are off a wheel by more than `lift` [m]),
/// or if the loop does not enclose all its wheels. A track that is only lifted is not thrown.
std::string thrownTrack(const Assembly& vehicle, int track, const multibody::State& state, double lift);

} // namespace grouser::vehicle

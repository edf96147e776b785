// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <string>

namespace grouser::base {

/// Why a simulation cannot go on, for whoever counts or judges runs by it; messages say it in words.
enum class Cause {
  unknown,
  unsettledBed,     ///< the bed did not come to rest, or not into the wanted state
  unstableContacts, ///< the steps make or lose energy in contacts
  pressedGrain,     ///< a grain is pressed into or through another or a part while the energies balance
  fastGrain,        ///< a grain leaves the reach of its neighbour list within a step
  lostGrain,        ///< a grain leaves the range of positions
  noNumber,         ///< a value is no number
  thrownPart,       ///< a part moves many times as far as in the step before
  fastTurn,         ///< a body turns too far in a step
  fastMotion,       ///< the solver finds no motion within a step
  growingSwings,    ///< swings across the pull in joints
  thrownTrack,      ///< a track leaves its wheels
  skippingTrack,    ///< a track skips teeth of its sprocket
  noRest,           ///< the vehicle does not come to rest
  offTerrain        ///< the vehicle leaves the terrain
};

/// What ends a run, in words; empty while all is well.
struct Alarm {
  std::string text;
  Cause cause{};
  bool empty() const { return text.empty(); }
};

template <> struct EnumWords<Cause> {
  using E = Cause;
  static constexpr EnumWord<E> list[] = {{E::unknown, "unknown"},
                                         {E::unsettledBed, "unsettled bed"},
                                         {E::unstableContacts, "unstable contacts"},
                                         {E::pressedGrain, "pressed grain"},
                                         {E::fastGrain, "fast grain"},
                                         {E::lostGrain, "lost grain"},
                                         {E::noNumber, "no number"},
                                         {E::thrownPart, "thrown part"},
                                         {E::fastTurn, "fast turn"},
                                         {E::fastMotion, "fast motion"},
                                         {E::growingSwings, "growing swings"},
                                         {E::thrownTrack, "thrown track"},
                                         {E::skippingTrack, "skipping track"},
                                         {E::noRest, "no rest"},
                                         {E::offTerrain, "off the terrain"}};
};

} // namespace grouser::base

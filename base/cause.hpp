// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <string>

namespace grouser::base {

/// Cause of a failed simulation, for programs that classify failed runs.
enum class Cause {
  unknown,
  unsettledBed,     ///< the bed did not come to rest or did not reach the requested porosity
  unstableContacts, ///< the time integration creates or loses energy in contacts
  excessiveOverlap, ///< an overlap is too large, although the energy balance is satisfied
  fastGrain,        ///< a grain moves farther than the skin of its neighbour list within a step
  lostGrain,        ///< a grain leaves the representable range of positions
  noNumber,         ///< a value is not a number (NaN)
  thrownPart,       ///< a part moves several times as far as in the previous step
  fastTurn,         ///< a body rotates too far in a step
  fastMotion,       ///< the constraint solver does not converge within a step
  growingSwings,    ///< oscillations transverse to joint tension grow
  thrownTrack,      ///< a track leaves its wheels
  skippingTrack,    ///< a track skips teeth of its sprocket
  noRest,           ///< the vehicle does not come to rest
  offTerrain        ///< the vehicle leaves the terrain
};

/// Message and cause of a failure; an empty message means no failure.
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
                                         {E::excessiveOverlap, "pressed grain"},
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

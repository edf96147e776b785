// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <cstddef>

namespace grouser::output {

/// Kind of a part in pictures; determines its colour. frames.h5 contains the words.
enum class PartKind {
  other, ///< also used for files from other programs
  chassis,
  shoe,
  sprocket,
  roadWheel,
  roller,
  idler,
  surface, ///< rigid surface in a scene with grains
  fixed,   ///< fixed body of a mechanism; the kinds below are its free bodies
  body0,
  body1,
  body2,
  body3,
  body4,
  body5
};

/// Kinds of the free bodies of a mechanism, used in rotation.
inline constexpr PartKind kBodyKinds[] = {PartKind::body0, PartKind::body1, PartKind::body2,
                                          PartKind::body3, PartKind::body4, PartKind::body5};

} // namespace grouser::output

template <> struct grouser::base::EnumWords<grouser::output::PartKind> {
  using E = output::PartKind;
  static constexpr EnumWord<E> list[] = {{E::other, "part"},        {E::chassis, "chassis"},      {E::shoe, "shoe"},
                                         {E::sprocket, "sprocket"}, {E::roadWheel, "road_wheel"}, {E::roller, "roller"},
                                         {E::idler, "idler"},       {E::surface, "surface"},      {E::fixed, "fixed"},
                                         {E::body0, "body 0"},      {E::body1, "body 1"},         {E::body2, "body 2"},
                                         {E::body3, "body 3"},      {E::body4, "body 4"},         {E::body5, "body 5"}};
};

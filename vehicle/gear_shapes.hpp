// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

namespace grouser::vehicle {

/// Contact geometry within the running gear and between shoes and rigid surfaces.
enum class GearContactModel {
  shapes, ///< by the dimensions of VehicleSpec::shapes
  samples ///< by sample points of the meshes
};

/// Dimensions of the contact surfaces of the running gear: plates, horns, bosses, discs and arcs [m]. Without them the
/// samples of the meshes define the contacts. y is measured from the middle plane of a part; all surfaces are symmetric
/// about it.
struct GearShapes {
  // Shoe.
  double plateInner{}, plateOuter{};      ///< wheel plates, from this |y| to that one
  double hornLength{}, hornWidth{};       ///< guide horn in x and y, at the level of the plates
  double hornTipLength{}, hornTipWidth{}; ///< ... and at its tip
  double bossRadius{};                    ///< of the bosses about the pins at x = +pitch/2
  double bossInner{}, bossOuter{};        ///< bosses, from this |y| to that one
  double padTop{};                        ///< z of the pad's upper face
  double grouserX{};                      ///< two grousers at x = +- this; one in the middle where it is 0
  double grouserWidth{};                  ///< length in x of a grouser
  double chamfer{};                       ///< of its lower edges and of the pad's, at 45 degrees
  // Road wheels, rollers, idler: two discs each.
  double discInner{}, discOuter{}; ///< discs, from this |y| to that one
  double discChamfer{};            ///< of the discs' edges, at 45 degrees
  // Sprocket: two toothed rings. A gap is a seat for the boss, then convex flanks up to the tip circle.
  double ringInner{}, ringOuter{}; ///< rings, from this |y| to that one
  double seatRadius{};             ///< of the seat's arc about the seated pin
  double seatHalfAngle{};          ///< the arc reaches this far from its bottom [rad]
  double flankRadius{};            ///< of the flanks' arcs, which go on from the seat without a kink
  double tipRadius{};              ///< of the teeth, from the axle
};

} // namespace grouser::vehicle

namespace grouser::base {

template <> struct EnumWords<vehicle::GearContactModel> {
  using E = vehicle::GearContactModel;
  static constexpr EnumWord<E> list[] = {{E::shapes, "shapes"}, {E::samples, "samples"}};
};

} // namespace grouser::base

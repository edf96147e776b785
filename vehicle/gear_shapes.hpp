// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

namespace grouser::vehicle {

/// Contact geometry within the running gear and between shoes and rigid surfaces.
enum class GearContactModel {
  shapes, ///< dimensions of VehicleSpec::shapes
  samples ///< sample points of the meshes
};

/// Dimensions of the contact surfaces of the running gear: plates, horns, bosses, discs and arcs [m]. Without these
/// dimensions, contacts use sample points of the meshes. y is measured from the mid-plane of a part; all surfaces are
/// symmetric about this plane.
struct GearShapes {
  // Shoe.
  double plateInner{}, plateOuter{};      ///< wheel plates: range of |y|
  double hornLength{}, hornWidth{};       ///< guide horn base in x and y, at the level of the plates
  double hornTipLength{}, hornTipWidth{}; ///< guide horn tip in x and y
  double bossRadius{};                    ///< radius of the pin bosses at x = +pitch/2
  double bossInner{}, bossOuter{};        ///< bosses: range of |y|
  double padTop{};                        ///< z of the pad's upper face
  double grouserX{};                      ///< two grousers at x = +- this value; 0: a single grouser in the middle
  double grouserWidth{};                  ///< grouser length in x
  double chamfer{};                       ///< 45-degree chamfer of the lower edges of grousers and pad
  // Road wheels, rollers, idler: two discs each.
  double discInner{}, discOuter{}; ///< discs: range of |y|
  double discChamfer{};            ///< 45-degree chamfer of the disc edges
  // Sprocket: two toothed rings. A gap consists of the boss seat and convex flanks up to the tip circle.
  double ringInner{}, ringOuter{}; ///< rings: range of |y|
  double seatRadius{};             ///< radius of the seat arc about the seated pin
  double seatHalfAngle{};          ///< half angle of the seat arc, from its bottom [rad]
  double flankRadius{};            ///< radius of the flank arcs, which are tangent to the seat arc
  double tipRadius{};              ///< tip radius of the teeth, from the axle
};

} // namespace grouser::vehicle

namespace grouser::base {

template <> struct EnumWords<vehicle::GearContactModel> {
  using E = vehicle::GearContactModel;
  static constexpr EnumWord<E> list[] = {{E::shapes, "shapes"}, {E::samples, "samples"}};
};

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/patch_lanes.hpp"

#include <array>

/// Gear contacts from part shapes. Each function integrates the pressure of the elastic foundation (PatchLaw) over the
/// part of surface A inside body B, by Gauss quadrature between closed-form contact limits. Positions and moments are
/// relative to the centre of mass of A, in world axes [m].
namespace grouser::contact {

/// Eight wheel rims, each on a plane rectangle of A. Idle lanes have zero width.
struct alignas(64) RimsOnPlates {
  Vec3P plate;                       ///< reference point of the rectangle: mid-length, across = 0
  Vec3P along, across;               ///< unit
  PointLanes halfLength, from, to;   ///< along; across [m]
  Vec3P axle, axis;                  ///< a point on the wheel axis; unit axis
  PointLanes radius;                 ///< rim radius [m]
  RelativeMotion<PointLanes> motion; ///< motion of A relative to the wheel
};

/// Number of Gauss points across the plate (strips) and along the chord of each strip.
struct RimQuadrature {
  static constexpr int kStrips = 3, kAlong = 4;
};
PressureLanes pressRims(const PatchLaw& law, double timeStep, const RimsOnPlates& rims);

/// A plane trapezoid of A, such as the side of a guide horn, against the side of a disc with a chamfered edge.
struct FaceAtDisc {
  base::Vec3d foot;              ///< middle of the longer edge
  base::Vec3d along;             ///< unit vector along the edges
  base::Vec3d up;                ///< vector from `foot` to the middle of the shorter edge, perpendicular to both [m]
  double halfFoot, halfTip;      ///< half lengths of the edges [m]
  base::Vec3d axle;              ///< intersection of the disc side with its axis
  base::Vec3d axis;              ///< unit, into the disc
  double radius, chamfer;        ///< disc radius; chamfer of its edge [m]
  RelativeMotion<double> motion; ///< motion of A relative to the disc
};
PatchPressure pressFace(const PatchLaw& law, double timeStep, const FaceAtDisc& face);

/// Profile of the gap between two sprocket teeth, in a plane with its origin at the seated pin: x along the pitch
/// circle, y outward. It consists of the seat arc about the pin, convex flanks tangent to it, and the tip circle.
class GapProfile {
public:
  static constexpr int kSeatPoints = 16; ///< quadrature points on each half of the seat
  static constexpr int kMaxTeeth = 64;
  static constexpr int kAround = 128; ///< quadrature points around a boss deep inside a tooth

  /// `teeth`: at most kMaxTeeth; `pinRadius`: radius of the circle of seated pins [m]; `seatHalfAngle` [rad]; other
  /// parameters as in vehicle::GearShapes.
  GapProfile(int teeth, double pinRadius, double seatRadius, double seatHalfAngle, double flankRadius,
             double tipRadius);

  int teeth;
  double pinRadius, seatRadius, flankRadius, tipRadius;
  double seatCos, seatSin;                                             ///< cosine and sine of the seat's half angle
  double flankX, flankY;                                               ///< centre of the flank's arc at x > 0
  double seatStep;                                                     ///< angle between seat points [rad]
  std::array<PointLanes, kSeatPoints / kPointLanes> sine, cosine;      ///< angles of the seat's points from its bottom
  std::array<std::array<PointLanes, 2>, kAround / kPointLanes> around; ///< cosine and sine of points about a boss
  std::array<double, kMaxTeeth> gapCos, gapSin;                        ///< directions of the gaps
};

/// Cylinder of A (pin boss) in a sprocket gap.
struct BossInGap {
  base::Vec3d boss;              ///< reference point on its axis
  base::Vec3d across;            ///< unit, along its axis
  base::Vec3d alongX, alongZ;    ///< unit axes of A perpendicular to it
  double radius, from, to;       ///< [m]; axial range inside the sprocket ring [m]
  base::Vec3d axle, axis;        ///< a point on the sprocket axis; unit axis
  base::Vec3d x, z;              ///< unit axes of the sprocket: gap 0 lies along x, gap numbers increase towards z
  RelativeMotion<double> motion; ///< motion of A relative to the sprocket
};
/// Returns the pressure of two patches, one per half of the gap: x < 0 and x > 0.
std::array<PatchPressure, 2> pressBoss(const PatchLaw& law, double timeStep, const GapProfile& gap,
                                       const BossInGap& boss);

} // namespace grouser::contact

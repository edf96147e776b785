// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"

#include <string>
#include <vector>

/// Generates the vehicle's meshes from a few lengths. Every part is a union of closed shells that may overlap; each
/// shell is a 2-manifold with outward, counter-clockwise triangles. Part frame: origin at the part's natural centre,
/// x forward, y left, z up; wheels turn about y. All lengths are in metres.
namespace grouser::assets {

using base::TriangleMesh;

/// Lengths that the parts of one track have in common.
struct TrackDims {
  double pitch{0.154};           ///< distance between neighbouring pins
  double plateTop{0.020};        ///< wheel plate above the line of pins
  double padBottom{-0.040};      ///< pad below the line of pins
  double grouserDepth{0.015};    ///< grouser tips below the pad
  double grouserX{0.045};        ///< grousers at x = +-this
  double grouserWidth{0.016};    ///< length of a grouser in x at its root
  double chamfer{0.003};         ///< chamfer of grouser tips, pad edges and wheel discs
  double plateHalfLength{0.068}; ///< plates and pad in x
  double plateInner{0.030};      ///< wheel plates from this |y| ...
  double plateOuter{0.110};      ///< ... to this one; discs of the wheels too
  double padHalfWidth{0.140};    ///< pad to this |y|
  double hornHeight{0.060};      ///< guide horn above the wheel plate
  double hornWidth{0.030};       ///< guide horn in y
  double hornLength{0.080};      ///< guide horn in x at the plate
  double hornTipLength{0.030};   ///< guide horn in x at its tip
  double hornTipWidth{0.018};    ///< guide horn in y at its tip
  double wheelGap{0.054};        ///< gap between a wheel's two discs
  double bossRadius{0.018};      ///< pin bosses, the only parts that touch the sprocket
  double bossInner{0.145};       ///< bosses from this |y| ...
  double bossOuter{0.175};       ///< ... to this one
  double pinRadius{0.010};       ///< pins, from |y| = plateOuter to bossOuter
  int bossFacets{48};            ///< facets of a boss
};

/// One track shoe: pad with two grousers, two wheel plates, guide horn, and the two bosses and pins of the joint at
/// x = +pitch/2 (bosses and pins at -pitch/2 belong to the neighbour). Origin between the pins.
TriangleMesh shoe(const TrackDims& dims = {});

/// Two discs on a hub: road wheel, roller, idler.
struct WheelDims {
  double radius{0.19};    ///< mean radius of the rim polygon
  double hubRadius{0.10}; ///< hub between the discs, clear of the horns
  int facets{128};        ///< number of facets of the rim
};
TriangleMesh wheel(const WheelDims& wheel, const TrackDims& dims = {});

/// Lengths of the sprocket. Profile of a gap: x tangential, y radial, relative to the pin seated in the gap.
struct SprocketDims {
  int teeth{10};
  double pinRadius{0.249177};             ///< radius of the circle of seated pins
  double seatRadius{0.0185};              ///< seat arc about the pin ...
  double seatHalfAngle{60};               ///< ... over +-this from its bottom [degrees]
  double flankRadius{0.060};              ///< convex flank arc ...
  double flankX{0.0680}, flankY{-0.0393}; ///< ... about (+-flankX, flankY)
  double tipX{0.0451}, tipY{0.0162};      ///< end of the flank
  double landRadius{0.2692};              ///< tooth tips
  double ringInner{0.150};                ///< toothed rings from this |y| ...
  double ringOuter{0.170};                ///< ... to this one
  double hubRadius{0.140};                ///< hub that joins them, clear of plates and horns
  int seatSegments{16}, flankSegments{5}, landSegments{3};
};

/// Gap k is centred at 360 k / teeth degrees in the x-z plane, measured from +x towards +z.
TriangleMesh sprocket(const SprocketDims& dims = {});

/// A rigid wheel with straight grousers, for rigs: a faceted drum with radial blades. The mesh is a single
/// shell.
struct GrouserWheelDims {
  double radius{0.225};           ///< radius of the drum, to the edges of its facets
  double width{0.200};            ///< width of drum and grousers
  int grousers{24};               ///< number of blades, the first on the +x side
  double grouserHeight{0.030};    ///< height of the blades' tips over the drum
  double grouserThickness{0.005}; ///< thickness of a blade
  int facets{6};                  ///< number of facets of the drum between two blades
};
/// Throws std::invalid_argument if the blades would overlap.
TriangleMesh grouserWheel(const GrouserWheelDims& dims = {});

/// Hull of the vehicle for pictures, not for contact. Origin: axle of the rear sprockets on the centre line.
TriangleMesh chassis();

/// A mesh and the name of its file, "shoe" for shoe.obj.
struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// The default vehicle's parts: shoe, road_wheel, roller, idler, sprocket, chassis.
std::vector<NamedMesh> vehicleParts();

/// Parts of the M113-like vehicle, in a separate folder: m113/shoe, road_wheel, idler, sprocket, chassis.
std::vector<NamedMesh> m113Parts();

/// Length scale: robot's running gear / default vehicle [-].
inline constexpr double kRobotScale = 0.35;
/// The robot's parts, in a separate folder: scaled parts of the default vehicle, and a hull.
std::vector<NamedMesh> robotParts();

/// Parts of rigs in runs/scenes: grouser_wheel.
std::vector<NamedMesh> rigParts();

/// OBJ text with nine significant digits; bitwise equal on every machine.
std::string toObj(const NamedMesh& part);

} // namespace grouser::assets

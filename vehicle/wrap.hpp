// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/spec.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace grouser::vehicle {

/// Point in the track plane relative to the sprocket axle: x forward, z up [m].
struct PlanePoint {
  double x{}, z{};
};

/// Number of pitches in each section of the loop, in pin order for a rear sprocket. With a front sprocket the order is
/// reversed, and the rear strand is in front.
struct WrapCounts {
  int sprocket{};   ///< edges between engaged pins
  int rearStrand{}; ///< from the sprocket down to the ground contact
  int ground{};
  int frontStrand{}; ///< from the ground contact up to the idler
  int idler{};       ///< edges between pins on the idler
  int top{};         ///< from the idler back to the sprocket
};

/// Exact closed polygon of the shoes around the wheels, with all edges one pitch long. Pins are numbered from the
/// sprocket's top gap, rearward and down, forward along the ground, up the idler and back along the top. Shoe i
/// connects pin i (its rear end, x = -pitch/2) and pin i+1 (x = +pitch/2). With a front sprocket the loop is the mirror
/// image, but pins are numbered from the top gap in the same direction: back along the top, down around the idler,
/// forward along the ground, up to the sprocket.
struct Wrap {
  WrapCounts counts;
  double pitch{};           ///< [m]
  double sprocketPhase{};   ///< sprocket angle about -y (from +x towards +z) at which the gaps match the pins [rad]
  double idlerX{};          ///< [m]
  double idlerFirstAngle{}; ///< angle of the first pin on the idler, from +x towards +z [rad]
  std::array<double, 6> kinks{}; ///< kinks [rad] in pin order: sprocket exit, ground start, ground end, idler entry,
                                 ///< idler exit, sprocket entry; in the reverse order for a front sprocket
  bool sprocketInFront = false;
  std::vector<PlanePoint> pins; ///< [shoes]

  /// Maximum deviation of an edge from one pitch [m].
  double closure() const;
  /// Middle of shoe i [m].
  PlanePoint shoeCentre(int i) const;
  /// Direction of shoe i's x axis, from +x towards +z [rad].
  double shoeAngle(int i) const;
};

/// Computes the exact shoe positions. Tries every split of the shoes over the sections, solves for idler x and first
/// pin angle by Newton's method so that both free strands have whole pitches, and selects the convex loop with most
/// pins in the sprocket, then with the idler nearest to its design position. Throws base::InputError, with the gap and
/// a remedy, if no loop closes within the idler's slide range.
Wrap wrapTrack(const VehicleSpec& spec);
/// Same as wrapTrack(), but returns empty if no loop closes.
std::optional<Wrap> findWrap(const VehicleSpec& spec);

/// Reason why the loop of a vehicle does not close, with a remedy.
struct ClosureFault {
  std::string gap;    ///< closure error, as text
  std::string advice; ///< "set idler.x = 2.8813, or set shoe.count = 46"; empty if neither closes the loop
};
/// Returns the closure fault; with the advised value, the vehicle passes the test `sound`.
ClosureFault closureFault(const VehicleSpec& spec, const std::function<bool(const VehicleSpec&)>& sound);

/// Length of the shortest pin loop around sprocket, road wheels and idler in their design positions [m].
double hullLength(const VehicleSpec& spec);

/// Orientation of a part with its x axis along `angle` in the track plane (from +x towards +z): a rotation by
/// -angle about +y.
base::Quat planeRotation(double angle);

} // namespace grouser::vehicle

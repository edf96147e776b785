// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// What a scene file says of a mechanism: plain structs, one a section. Keys, units, ranges and meanings stand in
/// runs/scene_tables.cpp.
namespace grouser::runs {

/// [[body]]
struct BodySection {
  std::string name;
  std::optional<double> mass;      ///< [kg]; required unless fixed
  std::vector<double> inertia;     ///< xx, yy, zz (, xy, xz, yz) [kg m2]; empty: of the box
  std::optional<base::Vec3d> box;  ///< [m] edges: what is drawn, and the inertia where none is given
  base::Vec3d position;            ///< of the centre of mass [m]
  std::optional<base::Vec3d> axis; ///< with angle: how the body's frame is turned from the world's
  std::optional<double> angle;     ///< [deg]
  std::vector<double> orientation; ///< w, x, y, z instead; empty: not given
  base::Vec3d velocity, spin;      ///< [m/s], [rad/s], world components
  bool fixed = false;
  bool operator==(const BodySection&) const = default;
};

/// [[joint]]
struct JointSection {
  std::string name, type = "revolute";
  std::vector<std::string> bodies;
  std::optional<base::Vec3d> point, axis, secondAxis;      ///< world, at the start
  std::optional<base::Vec3d> pointA, pointB, axisA, axisB; ///< each in its body's frame
  std::optional<double> length;                            ///< of a distance joint [m]
  double damping = 0;
  std::optional<std::array<double, 2>> limits; ///< [rad] or [m] from the start
  double stopStiffness = 0, stopDamping = 0;
  bool operator==(const JointSection&) const = default;
};

/// [[spring]]: between two points, or on the axis of a joint.
struct SpringSection {
  std::string name;
  std::vector<std::string> bodies;
  std::optional<base::Vec3d> pointA, pointB; ///< each in its body's frame [m]
  std::string joint;
  double stiffness = 0, damping = 0, preload = 0;
  std::optional<double> freePosition; ///< length [m], or axis position [m] or [rad]; empty: as at the start
  bool operator==(const SpringSection&) const = default;
};

/// [[drive]]
struct DriveSection {
  std::string name, joint, imposes = "speed";
  std::optional<double> value;
  std::vector<double> time, values; ///< instead of one value
  bool operator==(const DriveSection&) const = default;
};

/// All of a mechanism, in the file's order.
struct MechanismSections {
  std::vector<BodySection> bodies;
  std::vector<JointSection> joints;
  std::vector<SpringSection> springs;
  std::vector<DriveSection> drives;
  bool empty() const { return bodies.empty(); }
  bool operator==(const MechanismSections&) const = default;
};

} // namespace grouser::runs

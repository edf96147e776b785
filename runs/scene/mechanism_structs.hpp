// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/choices.hpp"
#include "runs/scene/surface_structs.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

/// Mechanism sections of a scene file as plain structs. mechanism_sections.cpp defines keys, units and ranges.
namespace grouser::scene {

/// [[body.shape]]: a surface by which a body touches grains.
struct ShapeSection {
  ShapeKind kind = ShapeKind::sphere;
  std::optional<base::Vec3d> size;      ///< [m] edges of a box
  std::optional<double> radius, length; ///< [m]; of a cone the base and the height
  std::optional<double> tipRadius;      ///< [m] of a cone; empty: 0
  std::optional<std::string> file;      ///< of a mesh; absolute path after loading
  std::optional<double> scale;          ///< of a mesh: metres a unit of the file; empty: 1
  std::optional<double> sphereRadius;   ///< [m] of a mesh; empty: chosen for what touches it
  base::Vec3d position;                 ///< [m] of its centre, of a mesh the file's origin, in the body's frame
  std::optional<base::Vec3d> axis;      ///< cylinder, capsule: its direction; cone: from base to tip; box, mesh: the
                                        ///< axis that angle turns about
  std::optional<double> angle;          ///< [deg]
  LoadedMesh loaded;                    ///< about the middle of the box that holds the mesh
  bool operator==(const ShapeSection&) const = default;
};

/// [[body]]
struct BodySection {
  std::string name;
  std::optional<double> mass;      ///< [kg]; empty: of its shapes, or fixed
  std::optional<double> density;   ///< [kg/m3] of its shapes; empty: mass is given
  std::vector<double> inertia;     ///< xx, yy, zz (, xy, xz, yz) [kg m2]; empty: of the box, else of its shapes
  std::optional<base::Vec3d> box;  ///< [m] edges: what is drawn, and the inertia where none is given
  base::Vec3d position;            ///< of the centre of mass [m]
  std::optional<base::Vec3d> axis; ///< with angle: how the body's frame is turned from the world's
  std::optional<double> angle;     ///< [deg]
  std::vector<double> orientation; ///< w, x, y, z instead; empty: not given
  base::Vec3d velocity, spin;      ///< [m/s], [rad/s], world components
  bool fixed = false;
  bool point = false;               ///< a mass without extent
  std::string material;             ///< contact material of its shapes
  std::vector<ShapeSection> shapes; ///< empty: it touches nothing
  std::optional<base::Vec3d> probe; ///< [m] edges of the box within which the mass of grains is recorded
  base::Vec3d probePosition;        ///< [m] of its centre, in the body's frame
  bool operator==(const BodySection&) const = default;
};

/// [[joint]]
struct JointSection {
  std::string name;
  multibody::JointType type = multibody::JointType::kRevolute;
  std::vector<std::string> bodies;
  std::optional<base::Vec3d> point, axis, secondAxis;      ///< world, at the start
  std::optional<base::Vec3d> pointA, pointB, axisA, axisB; ///< each in its body's frame
  std::optional<double> length;                            ///< of a distance joint [m]
  double damping = 0, slideDamping = 0;
  std::optional<std::array<double, 2>> limits; ///< [rad] or [m] from the start
  double stopStiffness = 0, stopDamping = 0;
  bool operator==(const JointSection&) const = default;
};

/// [[spring]]: between two points, or on an axis of a joint.
struct SpringSection {
  std::string name;
  std::vector<std::string> bodies;
  std::optional<base::Vec3d> pointA, pointB; ///< each in its body's frame [m]
  std::string joint;
  std::optional<multibody::JointAxis> actsOn; ///< empty: the only one
  double stiffness = 0, damping = 0, preload = 0;
  std::optional<double> freePosition; ///< length [m], or axis position [m] or [rad]; empty: as at the start
  std::optional<std::array<double, 2>> limits;
  double stopStiffness = 0, stopDamping = 0;
  bool operator==(const SpringSection&) const = default;
};

/// [[bushing]]
struct BushingSection {
  std::string name;
  std::vector<std::string> bodies;
  base::Vec3d point;               ///< world, at the start [m]
  std::optional<base::Vec3d> axis; ///< its z, in the world; empty: the world's axes
  base::Vec3d stiffness, damping, rotationStiffness, rotationDamping;
  bool operator==(const BushingSection&) const = default;
};

/// [[drive]]: the sum of the given terms.
struct DriveSection {
  std::string name, joint;
  std::optional<multibody::JointAxis> actsOn; ///< empty: the only one
  multibody::DriveKind imposes = multibody::DriveKind::kSpeed;
  std::optional<double> value;
  std::vector<double> polynomial;
  double amplitude = 0, frequency = 0, phase = 0; ///< sine; [Hz], [deg]
  std::vector<double> time, values;
  bool operator==(const DriveSection&) const = default;
};

/// [[coupling]]: position of the second axis = ratio x position of the first + offset.
struct CouplingSection {
  std::string name;
  std::vector<std::string> joints;
  std::vector<multibody::JointAxis> actsOn; ///< one a joint; empty: the only one of each
  double ratio = 1;
  std::optional<double> offset;
  bool operator==(const CouplingSection&) const = default;
};

/// [mechanism]: placement of all bodies together.
struct MechanismPlacement {
  std::optional<double> aboveBed; ///< [m] between the shapes and the settled bed under them
  bool operator==(const MechanismPlacement&) const = default;
};

/// All of a mechanism, in the file's order.
struct MechanismSections {
  std::optional<MechanismPlacement> placement;
  std::vector<BodySection> bodies;
  std::vector<JointSection> joints;
  std::vector<SpringSection> springs;
  std::vector<BushingSection> bushings;
  std::vector<DriveSection> drives;
  std::vector<CouplingSection> couplings;
  bool empty() const { return bodies.empty(); }
  /// Returns true if any body has a contact shape.
  bool touches() const {
    return std::any_of(bodies.begin(), bodies.end(), [](const BodySection& b) { return !b.shapes.empty(); });
  }
  /// Returns true if any shape is a mesh.
  bool hasMeshes() const {
    return std::any_of(bodies.begin(), bodies.end(), [](const BodySection& b) {
      return std::any_of(b.shapes.begin(), b.shapes.end(),
                         [](const ShapeSection& s) { return s.kind == ShapeKind::mesh; });
    });
  }
  /// Returns true without any section of a mechanism.
  bool hasNoParts() const {
    return bodies.empty() && joints.empty() && springs.empty() && bushings.empty() && drives.empty() &&
           couplings.empty();
  }
  bool operator==(const MechanismSections&) const = default;
};

/// Calls `f` for each kind with its key in a file, in an order in which each refers to earlier ones only.
template <class Sections, class F> void forEachKind(Sections& s, F f) {
  f("body", s.bodies), f("joint", s.joints), f("spring", s.springs), f("bushing", s.bushings);
  f("drive", s.drives), f("coupling", s.couplings);
}

} // namespace grouser::scene

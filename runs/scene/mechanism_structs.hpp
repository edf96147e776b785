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

/// [[body.shape]]: a contact surface of a body.
struct ShapeSection {
  ShapeKind kind = ShapeKind::sphere;
  std::optional<base::Vec3d> size;      ///< [m] edges of a box
  std::optional<double> radius, length; ///< [m]; cone: radius of the base, and height
  std::optional<double> tipRadius;      ///< [m] radius of a cone's tip; empty: 0
  std::optional<std::string> file;      ///< mesh file; absolute path after loading
  std::optional<double> scale;          ///< metres per length unit of the mesh file; empty: 1
  std::optional<double> sphereRadius;   ///< [m] sphere radius of a mesh; empty: from its diagonal and its contacts,
                                        ///< or no spheres if it is exactly a box
  base::Vec3d position;                 ///< [m] centre in the body's frame; mesh: the file's origin
  std::optional<base::Vec3d> axis;      ///< cylinder, capsule: direction; cone: from base to tip; box, mesh:
                                        ///< rotation axis of `angle`
  std::optional<double> angle;          ///< [deg]
  LoadedMesh loaded;                    ///< centred on the bounding box of the mesh, or exactly a box
  bool operator==(const ShapeSection&) const = default;
};

/// [[body]]
struct BodySection {
  std::string name;
  std::optional<double> mass;      ///< [kg]; empty: computed from the shapes, or the body is fixed
  std::optional<double> density;   ///< [kg/m3] density of the shapes; empty: mass is given
  std::vector<double> inertia;     ///< xx, yy, zz (, xy, xz, yz) [kg m2]; empty: from the box, else from its shapes
  std::optional<base::Vec3d> box;  ///< [m] edges of the drawn box; it sets the inertia unless given
  base::Vec3d position;            ///< [m] centre of mass
  std::optional<base::Vec3d> axis; ///< axis of the body's rotation by `angle`
  std::optional<double> angle;     ///< [deg]
  std::vector<double> orientation; ///< quaternion w, x, y, z, instead of axis and angle; empty: not given
  base::Vec3d velocity, spin;      ///< [m/s], [rad/s], world components
  bool fixed = false;
  bool point = false;                   ///< a mass without extent
  std::string material;                 ///< contact material of its shapes
  std::vector<ShapeSection> shapes;     ///< empty: no contacts
  std::optional<double> largestOverlap; ///< [m] of its shapes with surfaces and bodies; empty: from each shape
  std::optional<base::Vec3d> probe;     ///< [m] edges of the box in which the grain mass is recorded
  base::Vec3d probePosition;            ///< [m] centre of the probe box in the body's frame
  bool operator==(const BodySection&) const = default;
};

/// [[joint]]
struct JointSection {
  std::string name;
  multibody::JointType type = multibody::JointType::kRevolute;
  std::vector<std::string> bodies;
  std::optional<base::Vec3d> point, axis, secondAxis;      ///< initial, in the world frame
  std::optional<base::Vec3d> pointA, pointB, axisA, axisB; ///< each in the frame of its body
  std::optional<double> length;                            ///< length of a distance joint [m]
  double damping = 0, slideDamping = 0;
  std::optional<std::array<double, 2>> limits; ///< [rad] or [m] from the initial position
  double stopStiffness = 0, stopDamping = 0;
  bool operator==(const JointSection&) const = default;
};

/// [[spring]]: between two points, or on an axis of a joint.
struct SpringSection {
  std::string name;
  std::vector<std::string> bodies;
  std::optional<base::Vec3d> pointA, pointB; ///< each in its body's frame [m]
  std::string joint;
  std::optional<multibody::JointAxis> actsOn; ///< empty: the only axis of the joint
  double stiffness = 0, damping = 0, preload = 0;
  std::optional<double> freePosition; ///< length [m], or axis position [m] or [rad]; empty: initial value
  std::optional<std::array<double, 2>> limits;
  double stopStiffness = 0, stopDamping = 0;
  bool operator==(const SpringSection&) const = default;
};

/// [[bushing]]
struct BushingSection {
  std::string name;
  std::vector<std::string> bodies;
  base::Vec3d point;               ///< initial position in the world frame [m]
  std::optional<base::Vec3d> axis; ///< z axis of the bushing in the world frame; empty: the world's axes
  base::Vec3d stiffness, damping, rotationStiffness, rotationDamping;
  bool operator==(const BushingSection&) const = default;
};

/// [[drive]]: the sum of the given terms.
struct DriveSection {
  std::string name, joint;
  std::optional<multibody::JointAxis> actsOn; ///< empty: the only axis of the joint
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
  std::vector<multibody::JointAxis> actsOn; ///< one per joint; empty: the only axis of each
  double ratio = 1;
  std::optional<double> offset;
  bool operator==(const CouplingSection&) const = default;
};

/// [mechanism]: placement of all bodies together.
struct MechanismPlacement {
  std::optional<double> aboveBed; ///< [m] gap between the shapes and the settled bed below them
  bool operator==(const MechanismPlacement&) const = default;
};

/// All sections of a mechanism, in the order of the file.
struct MechanismSections {
  std::optional<MechanismPlacement> placement;
  std::vector<BodySection> bodies;
  std::vector<JointSection> joints;
  std::vector<SpringSection> springs;
  std::vector<BushingSection> bushings;
  std::vector<DriveSection> drives;
  std::vector<CouplingSection> couplings;
  /// Returns true if the scene has no section of a mechanism. Without bodies, springs and bushings can still connect
  /// the vehicle to the world.
  bool empty() const {
    return bodies.empty() && joints.empty() && springs.empty() && bushings.empty() && drives.empty() &&
           couplings.empty();
  }
  /// Returns true if any body has a contact shape.
  bool touches() const {
    return std::any_of(bodies.begin(), bodies.end(), [](const BodySection& b) { return !b.shapes.empty(); });
  }
  /// Returns true if any shape is a mesh, except meshes that are exactly boxes.
  bool hasMeshes() const {
    return std::any_of(bodies.begin(), bodies.end(), [](const BodySection& b) {
      return std::any_of(b.shapes.begin(), b.shapes.end(),
                         [](const ShapeSection& s) { return s.loaded.query != nullptr; });
    });
  }
  bool operator==(const MechanismSections&) const = default;
};

/// Calls `f` with the key and the list of each kind of section. Sections refer only to kinds that come earlier.
template <class Sections, class F> void forEachKind(Sections& s, F f) {
  f("body", s.bodies), f("joint", s.joints), f("spring", s.springs), f("bushing", s.bushings);
  f("drive", s.drives), f("coupling", s.couplings);
}

} // namespace grouser::scene

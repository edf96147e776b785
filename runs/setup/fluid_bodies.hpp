// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/fluid_domain_setup.hpp"
#include "coupling/mechanism_setup.hpp"

#include <optional>
#include <vector>

namespace grouser::scene {
struct Scene;
} // namespace grouser::scene

namespace grouser::setup {

/// Markers of a shape, in its frame: in layers from half a spacing below its surface down to `depth` [m]. Layers of a
/// box, cylinder or sphere are parallel to its surface; markers of other shapes are points of a lattice. `flat`: only
/// the layer through the middle along this axis of the shape (0, 1, 2), or -1.
std::vector<base::Vec3d> shapeMarkers(const coupling::BodyShape& shape, double spacing, double depth, int flat = -1);

/// Vehicle and bodies of a scene in their initial poses, with the shapes that a fluid acts on.
class StartingBodies {
public:
  /// The shape of a vehicle part is its mesh. Throws InputError if bodies are hitched to the vehicle.
  explicit StartingBodies(const scene::Scene& scene);

  bool empty() const { return placed_.empty(); }
  /// Pose of the vehicle's chassis; empty without a vehicle.
  std::optional<base::Pose> chassis() const;
  const base::Pose& pose(std::size_t body) const { return bodies_[body].pose; }
  bool ofVehicle(std::size_t body) const { return body < ofVehicle_; }
  /// Returns the bodies with shapes. Throws InputError if a shape is thinner than the spacing, or, in two dimensions,
  /// is neither a box nor a cylinder perpendicular to the plane.
  std::vector<coupling::BodyInFluid> inFluid(const scene::Scene& scene, const fluid::FluidModel& model) const;

  /// Volume of the vehicle's parts below a level [m3], by sampling points inside their meshes.
  double vehicleBelow(double level) const;

  /// Distances from the nearest part of the vehicle, and from the nearest other body [m], limited to `most`.
  double fromVehicle(const base::Vec3d& p, double most) const { return distance(p, 0, parts_, most); }
  double fromBodies(const base::Vec3d& p, double most) const { return distance(p, parts_, placed_.size(), most); }

private:
  struct Placed {
    coupling::BodyShape shape;
    base::Pose pose; ///< in the world
    double reach;    ///< bounding radius about the origin [m]
  };
  void addVehicle(const scene::Scene& scene);
  void add(const coupling::BodyShape& shape);
  double distance(const base::Vec3d& p, std::size_t first, std::size_t last, double most) const;

  std::vector<multibody::Body> bodies_; ///< bodies of the vehicle before the others
  std::vector<std::string> columns_;    ///< [body] column of the output (BodyInFluid::column)
  std::size_t ofVehicle_{0};            ///< number of the vehicle's bodies
  std::size_t parts_{0};                ///< number of the vehicle's shapes, which come first
  std::vector<Placed> placed_;
};

} // namespace grouser::setup

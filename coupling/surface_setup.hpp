// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "coupling/surface_motion.hpp"
#include "spheredecomp/mesh_query.hpp"
#include "terrain/grain_setup.hpp"
#include "terrain/rigid_surface.hpp"

#include <memory>
#include <optional>
#include <string>

namespace grouser::coupling {

/// Kinds of surface sections.
enum class SurfaceKind { plane, box, cylinder, mesh };

/// Surface moved by forces along one axis, relative to its prescribed motion. The mass is at the pivot: rotating
/// surfaces are balanced about it.
struct FreeSurface {
  base::Vec3d axis;  ///< unit vector
  double mass{};     ///< [kg]
  double load{};     ///< load along the axis, in addition to gravity [N]
  double loadRamp{}; ///< duration of the load ramp [s]

  double loadAt(double time) const { return load * (time < loadRamp ? time / loadRamp : 1); } ///< [N]
};

/// Rigid surface of a scene for contact with grains, from any kind of section.
struct SurfaceSetup {
  std::string name; ///< "lid"
  SurfaceKind kind{};
  std::size_t number{}; ///< index among surfaces of its kind
  std::string place;    ///< location of its section, for messages: "scene.toml:14: box.0"
  std::string material;
  terrain::SurfaceGeometry geometry; ///< geometry; for a mesh its bounding box
  base::Pose start;
  SurfaceMotion motion;
  std::optional<FreeSurface> free;
  bool moves{};                                          ///< true: moved by its prescribed motion or by forces
  bool hasPivot{};                                       ///< true: its torque about the pivot is recorded too
  std::shared_ptr<const spheredecomp::MeshQuery> mesh{}; ///< null except for meshes
  double sphereRadius{};                                 ///< radius of the spheres of a mesh [m]
  bool sphereRadiusGiven{};                              ///< true: radius set in the scene; false: it may be refined
  double sphereRefinement{1};                            ///< [-] divides the radius and the limits of an automatic one
  bool placedLater{};               ///< true: placed on a bed settled without it; false: the bed is built around it
  std::optional<double> aboveBed{}; ///< then: height of its lowest point above the highest grain below it [m]

  void lift(double way); ///< raises the initial pose and the whole motion [m]
};

/// Initial pose, at rest.
terrain::SurfacePose startingPose(const SurfaceSetup& surface);
/// Initial overlap of a sphere with the surface [m]; negative: gap.
double startingOverlap(const SurfaceSetup& surface, const base::Vec3d& position, double radius);
/// Overlap of a sphere with the surface, with the surface frame at `pose` [m].
double overlapAt(const SurfaceSetup& surface, const base::Pose& pose, const base::Vec3d& position, double radius);

/// Axis-aligned bounding box in the world of a box, cylinder, tube or mesh [m]; undefined for a plane.
struct SurfaceBounds {
  base::Vec3d low, high;
};
SurfaceBounds boundsOf(const SurfaceSetup& surface, const base::Pose& pose);

/// Checks a surface at periodic boundaries, beyond which boxes, cylinders and meshes have no images: it must be at
/// least `radius` away from both boundaries, or extend across both. Returns an error message, or an empty string.
/// `radius`: radius of the largest grain [m].
std::string faultAtBoundaries(const SurfaceSetup& surface, const base::Pose& pose,
                              const terrain::PeriodicBoundaries& sides, double radius);

} // namespace grouser::coupling

template <> struct grouser::base::EnumWords<grouser::coupling::SurfaceKind> {
  using E = coupling::SurfaceKind;
  static constexpr EnumWord<E> list[] = {
      {E::plane, "plane"}, {E::box, "box"}, {E::cylinder, "cylinder"}, {E::mesh, "mesh"}};
};

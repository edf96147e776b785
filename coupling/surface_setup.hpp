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

/// Kinds of sections of surfaces.
enum class SurfaceKind { plane, box, cylinder, mesh };

/// A surface moved by forces along one axis, relative to its prescribed motion. The mass is at the pivot: rotating
/// surfaces are balanced about it.
struct FreeSurface {
  base::Vec3d axis;  ///< unit vector
  double mass{};     ///< [kg]
  double load{};     ///< besides gravity, along the axis [N]
  double loadRamp{}; ///< duration of the load ramp [s]

  double loadAt(double time) const { return load * (time < loadRamp ? time / loadRamp : 1); } ///< [N]
};

/// One rigid surface of a scene for contact with grains, from any kind of section.
struct SurfaceSetup {
  std::string name; ///< "lid"
  SurfaceKind kind{};
  std::size_t number{}; ///< among those of its kind
  std::string place;    ///< of its section, in messages: "scene.toml:14: box.0"
  std::string material;
  terrain::SurfaceGeometry geometry; ///< of a mesh its bounding box
  base::Pose start;
  SurfaceMotion motion;
  std::optional<FreeSurface> free;
  bool moves{};                                          ///< by its motion or by forces
  bool hasPivot{};                                       ///< as a reference point of its torque
  std::shared_ptr<const spheredecomp::MeshQuery> mesh{}; ///< null except for meshes
  double sphereRadius{};                                 ///< of the spheres of a mesh [m]
  bool sphereRadiusGiven{};                              ///< set in the scene; else it may become finer
  double sphereRefinement{1};                            ///< [-] divides it and the limits of an automatic one
  bool placedLater{};               ///< placed on a bed settled without it; else the bed is laid around it
  std::optional<double> aboveBed{}; ///< then: height of its lowest point over the highest grain under it [m]

  void lift(double way); ///< lifts the start and the whole motion [m]
};

/// Pose at the start, at rest.
terrain::SurfacePose startingPose(const SurfaceSetup& surface);
/// Overlap of a sphere with it at the start [m]; negative if they do not touch.
double startingOverlap(const SurfaceSetup& surface, const base::Vec3d& position, double radius);
/// The same with the surface's frame at `pose`.
double overlapAt(const SurfaceSetup& surface, const base::Pose& pose, const base::Vec3d& position, double radius);

/// Bounding box along the world's axes of a box, cylinder, tube or mesh [m]; a plane has none.
struct SurfaceBounds {
  base::Vec3d low, high;
};
SurfaceBounds boundsOf(const SurfaceSetup& surface, const base::Pose& pose);

/// A box, cylinder or mesh has no images beyond periodic boundaries. So it must keep `radius` away from both
/// boundaries, or extend across both: returns a message if it does not, else an empty string. `radius`: of the largest
/// grain [m].
std::string faultAtBoundaries(const SurfaceSetup& surface, const base::Pose& pose,
                              const terrain::PeriodicBoundaries& sides, double radius);

} // namespace grouser::coupling

template <> struct grouser::base::EnumWords<grouser::coupling::SurfaceKind> {
  using E = coupling::SurfaceKind;
  static constexpr EnumWord<E> list[] = {
      {E::plane, "plane"}, {E::box, "box"}, {E::cylinder, "cylinder"}, {E::mesh, "mesh"}};
};

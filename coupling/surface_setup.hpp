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

/// The lists of sections that surfaces stand in.
enum class SurfaceKind { plane, box, cylinder, mesh };

/// A surface that forces move along one axis, beside what its law of motion says: that carries a frame which is free
/// along the axis. The mass is at the pivot: what turns is balanced about it.
struct FreeSurface {
  base::Vec3d axis;  ///< unit vector
  double mass{};     ///< [kg]
  double load{};     ///< beside gravity, along the axis [N]
  double loadRamp{}; ///< over which the load comes on [s]

  double loadAt(double time) const { return load * (time < loadRamp ? time / loadRamp : 1); } ///< [N]
};

/// One rigid surface of a scene as grains meet it, whatever section it stands in.
struct SurfaceSetup {
  std::string name; ///< "lid"
  SurfaceKind kind{};
  std::size_t number{}; ///< among those of its kind
  std::string place;    ///< of its section, in messages: "scene.toml:14: box.0"
  std::string material;
  terrain::SurfaceGeometry geometry; ///< of a mesh the box that holds it
  base::Pose start;
  SurfaceMotion motion;
  std::optional<FreeSurface> free;
  bool moves{};                                          ///< by its motion or by forces
  bool hasPivot{};                                       ///< about which its torque is told too
  std::shared_ptr<const spheredecomp::MeshQuery> mesh{}; ///< null but for meshes
  double sphereRadius{};                                 ///< of the spheres that a mesh is cut into [m]
  bool sphereRadiusGiven{};                              ///< by the scene; else it may become finer
  double sphereRefinement{1};                            ///< [-] divides it and what an automatic one permits
  bool placedLater{};               ///< put on a bed that has settled without it; else the bed is laid around it
  std::optional<double> aboveBed{}; ///< then: height of its lowest point over the highest grain under it [m]

  void lift(double way); ///< the start, and all of its motion [m]
};

/// At rest where it stands at the start.
terrain::SurfacePose startingPose(const SurfaceSetup& surface);
/// Overlap of a sphere with it at the start [m]; negative where they do not touch.
double startingOverlap(const SurfaceSetup& surface, const base::Vec3d& position, double radius);
/// The same where the surface's own frame has come to `pose`.
double overlapAt(const SurfaceSetup& surface, const base::Pose& pose, const base::Vec3d& position, double radius);

/// The box along the world's axes that holds a box, cylinder, tube or mesh [m]; a plane has none.
struct SurfaceBounds {
  base::Vec3d low, high;
};
SurfaceBounds boundsOf(const SurfaceSetup& surface, const base::Pose& pose);

/// Grains feel a box, cylinder or mesh where it is, and no images of it beyond periodic boundaries. So it has to keep
/// `radius` away from both boundaries, or to reach across both: says how it does not, or nothing. `radius`: of the
/// largest grain [m].
std::string faultAtBoundaries(const SurfaceSetup& surface, const base::Pose& pose,
                              const terrain::PeriodicBoundaries& sides, double radius);

} // namespace grouser::coupling

template <> struct grouser::base::EnumWords<grouser::coupling::SurfaceKind> {
  using E = coupling::SurfaceKind;
  static constexpr EnumWord<E> list[] = {
      {E::plane, "plane"}, {E::box, "box"}, {E::cylinder, "cylinder"}, {E::mesh, "mesh"}};
};

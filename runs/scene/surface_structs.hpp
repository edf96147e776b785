// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/choices.hpp"
#include "spheredecomp/mesh_box.hpp"
#include "spheredecomp/mesh_query.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Rigid surfaces of a scene file as plain structs, one per section. surface_sections.cpp defines keys, units and
/// ranges.
namespace grouser::scene {

/// Keys common to all rigid surfaces.
struct SurfaceSection {
  std::optional<std::string> name; ///< in results; empty: kind and number
  std::string material;
  std::optional<base::Vec3d> velocity;    ///< [m/s]
  std::optional<base::Vec3d> spin;        ///< [rad/s]
  std::optional<base::Vec3d> pivot;       ///< [m] centre of rotation; empty: centre of the surface
  std::optional<base::Vec3d> amplitude;   ///< [m] amplitude vector of an oscillation
  std::optional<double> frequency, phase; ///< [Hz], [deg] of the oscillation
  std::optional<double> start, until;     ///< [s] start and end of the prescribed motion
  std::optional<Axis> free;               ///< axis along which forces move the surface
  std::optional<double> loadRamp;         ///< [s] ramp duration of the load
  std::optional<double> mass, load;       ///< [kg], [N] of a free surface
  std::optional<PlacedWhen> placed;       ///< time of placement in scenes with a settling bed
  std::optional<double> aboveBed;         ///< [m] gap between its lowest point and the settled bed
  bool operator==(const SurfaceSection&) const = default;

  bool moves() const { return velocity || spin || amplitude || free; }
};

/// [[plane]]: fills the half-space behind its normal.
struct Plane : SurfaceSection {
  base::Vec3d point, normal{0, 0, 1};
  bool operator==(const Plane&) const = default;
  /// Returns true if the plane is fixed, has no name, and exists from the start, like the walls of a bed.
  bool isWall() const { return !moves() && !name && !aboveBed && placed != PlacedWhen::afterSettling; }
};

/// [[box]]
struct BoxSection : SurfaceSection {
  base::Vec3d position, size; ///< [m] centre; edge lengths
  std::optional<base::Vec3d> axis;
  std::optional<double> angle;                    ///< [deg] rotation about `axis` from the world's axes
  std::optional<std::vector<double>> orientation; ///< w, x, y, z, instead of axis and angle
  bool operator==(const BoxSection&) const = default;
};

/// [[cylinder]]
struct CylinderSection : SurfaceSection {
  base::Vec3d position, axis{0, 0, 1}; ///< [m] centre; direction
  double radius = 0, length = 0;       ///< [m]
  bool hollow = false;                 ///< a pipe without thickness, open at both ends
  bool operator==(const CylinderSection&) const = default;
};

/// Mesh of a file, read when the scene was loaded [m].
struct LoadedMesh {
  std::shared_ptr<const spheredecomp::MeshQuery> query; ///< null if `box` is set
  double sphereRadius{};                                ///< as given, or by default [m]
  std::string note;   ///< changes that were made on reading, and the exact box; empty: none
  base::Vec3d middle; ///< centre of the bounding box, or of `box`, in the file [m]; set for bodies
  std::optional<spheredecomp::MeshBox> box; ///< the mesh of a body if it is exactly a box and has no sphere radius
  bool operator==(const LoadedMesh&) const { return true; } // the file name is compared
};

/// [[mesh]]
struct MeshSection : SurfaceSection {
  /// Default sphere radius: diagonal of the mesh / this number.
  static constexpr double kRadiiInDiagonal = 40;
  static constexpr const char* kShareOfDiagonal = "a fortieth";

  std::string file;     ///< absolute path after loading
  double scale = 1;     ///< metres per unit of the file
  base::Vec3d position; ///< [m] position of the file's origin
  std::optional<base::Vec3d> axis;
  std::optional<double> angle;                    ///< [deg]
  std::optional<std::vector<double>> orientation; ///< w, x, y, z
  std::optional<double> sphereRadius;             ///< [m]; empty: automatic
  double sphereRefinement = 1; ///< [-] divisor of the sphere radius, and of the limits of an automatic one
  LoadedMesh loaded;
  bool operator==(const MeshSection&) const = default;
};

} // namespace grouser::scene

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/scene/choices.hpp"
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
  std::optional<base::Vec3d> pivot;       ///< [m] that it turns about; empty: its own centre
  std::optional<base::Vec3d> amplitude;   ///< [m] of an oscillation along this vector
  std::optional<double> frequency, phase; ///< [Hz], [deg] of that oscillation
  std::optional<double> start, until;     ///< [s] between which all this takes place
  std::optional<Axis> free;               ///< along which forces move it
  std::optional<double> loadRamp;         ///< [s] over which the load comes on
  std::optional<double> mass, load;       ///< [kg], [N] of a free surface
  std::optional<PlacedWhen> placed;       ///< beside a bed that settles first
  std::optional<double> aboveBed;         ///< [m] of its lowest point over the settled bed
  bool operator==(const SurfaceSection&) const = default;

  bool moves() const { return velocity || spin || amplitude || free; }
};

/// [[plane]]: fills the half-space behind its normal.
struct Plane : SurfaceSection {
  base::Vec3d point, normal{0, 0, 1};
  bool operator==(const Plane&) const = default;
  /// Returns true if it has no motion and no name, and is there from the start, like the walls of a bed.
  bool isWall() const { return !moves() && !name && !aboveBed && placed != PlacedWhen::afterSettling; }
};

/// [[box]]
struct BoxSection : SurfaceSection {
  base::Vec3d position, size; ///< [m] of its centre; edges
  std::optional<base::Vec3d> axis;
  std::optional<double> angle;                    ///< [deg] with axis: how its edges are turned from the world's axes
  std::optional<std::vector<double>> orientation; ///< w, x, y, z instead
  bool operator==(const BoxSection&) const = default;
};

/// [[cylinder]]
struct CylinderSection : SurfaceSection {
  base::Vec3d position, axis{0, 0, 1}; ///< [m] of its centre; direction
  double radius = 0, length = 0;       ///< [m]
  bool hollow = false;                 ///< a pipe without thickness, open at both ends
  bool operator==(const CylinderSection&) const = default;
};

/// Mesh of a file, read when the scene was loaded [m].
struct LoadedMesh {
  std::shared_ptr<const spheredecomp::MeshQuery> query;
  double sphereRadius{}; ///< as given, or by default [m]
  std::string note;      ///< on how it was read; empty: nothing
  base::Vec3d middle;    ///< centre of the bounding box in the file [m]; set for bodies
  bool operator==(const LoadedMesh&) const { return true; } // the file name is compared
};

/// [[mesh]]
struct MeshSection : SurfaceSection {
  /// Default sphere radius: the mesh's diagonal over this.
  static constexpr double kRadiiInDiagonal = 40;
  static constexpr const char* kShareOfDiagonal = "a fortieth";

  std::string file;     ///< absolute path after loading
  double scale = 1;     ///< metres a unit of the file
  base::Vec3d position; ///< [m] of the file's origin
  std::optional<base::Vec3d> axis;
  std::optional<double> angle;                    ///< [deg]
  std::optional<std::vector<double>> orientation; ///< w, x, y, z
  std::optional<double> sphereRadius;             ///< [m]; empty: chosen for what touches the mesh
  double sphereRefinement = 1;                    ///< [-] divides it, and an automatic one's limits
  LoadedMesh loaded;
  bool operator==(const MeshSection&) const = default;
};

} // namespace grouser::scene

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/comm.hpp"
#include "base/fixed_point.hpp"
#include "terrain/grain_arrays.hpp"
#include "terrain/searched_height_field.hpp"

#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace grouser::terrain {

/// Walls, floor and surfaces on the device, the list of grains near them, and the contact loads of a step.
class GrainBoundaries {
public:
  GrainBoundaries(const base::Exec& exec, const GrainConstants& constants, const Boundaries& boundaries);

  bool any() const { return count_ > 0; }
  bool hasSurfaces() const { return !geometries_.empty(); }

  /// Sets the poses of the surfaces for the next step, one per surface; the same on all ranks.
  void setSurfacePoses(const std::vector<SurfacePose>& poses);
  /// Loads of all grains on the surfaces in the last step: order-independent sums, opposite to the loads on the grains.
  const std::vector<SurfaceLoad>& surfaceLoads() const { return surfaceLoads_; }

  std::span<const SurfacePose> surfacePoses() const { return {poses_.host(), geometries_.size()}; }
  double strongest() const { return strongest_; } ///< upper bound of the force of a contact with a surface [N]

  /// True if the list of grains near surfaces must be rebuilt. Depends only on the poses, so all ranks agree.
  bool surfacesHaveLeft() const;
  /// Lists the grains that may reach a boundary before the next list, and those in contact, with their springs. `d`:
  /// kernel data of the grains in their current slots; `ghosts`: nonzero for those to skip; null without ghosts.
  void list(const GrainConstants& constants, const GrainKernelData& d, GrainArrays& arrays,
            const std::uint32_t* ghosts);
  std::size_t grainsListed() const { return near_.size(); }

  // Springs of walls, floor and surfaces: only for listed grains, by list index.

  std::size_t springsWidth() const { return springsWidth_; } ///< values per grain; 0 without friction
  const base::Array<float>& springs() const { return springs_; }
  /// Sets the springs of a loaded state: rows that boundaryOf counts from 1, until the next list.
  void setSprings(const std::vector<float>& springs) { springs_.assign(springs); }
  /// Copies the springs of the grains in `slots` (device array) for other ranks, contiguously.
  base::Array<float> exportSprings(const GrainFields& fields, const std::uint32_t* slots, std::size_t count) const;
  /// Extends the springs by `count` grains received from other ranks and returns their address; null without friction.
  float* makeRoomForSprings(std::size_t count);
  /// Sets the spring indices of the `count` received slots starting at `first`.
  void numberArrived(GrainFields& fields, std::size_t first, std::size_t count) const;

  std::int64_t listings() const { return listings_; } ///< number of lists built in scenes with surfaces

  // The loads of a step.
  void clearSurfaceLoads();                         ///< call before the step; runs on the device
  void downloadSurfaceLoads();                      ///< call after the step; does not wait
  void collectSurfaceLoads(const base::Comm& comm); ///< sums over the ranks; call after synchronize(); collective
  /// Loads of walls, floor and surfaces on the grains, by list index.
  template <class Real> BoundaryLoad<Real>* loads() {
    if constexpr (std::is_same_v<Real, float>)
      return singleLoads_.data();
    else
      return doubleLoads_.data();
  }

  /// Surface that a sphere [m] overlaps by more than `allowed` [m], with the overlap; empty if there is none.
  struct Overlap {
    std::size_t surface;
    double depth; ///< [m]
  };
  std::optional<Overlap> overlapOf(const base::Vec3d& centre, double radius, double allowed) const;

  void describe(GrainKernelData& d);
  std::size_t bytes() const;

private:
  void makeSurfaces(const GrainModel& model, const std::vector<RigidSurface>& surfaces);

  base::Exec exec_;
  int count_;   ///< number of walls, floor contacts and surfaces
  double room_; ///< maximum motion of surfaces between two lists [m]

  base::Array<Wall> walls_;
  SearchedHeightField floor_;

  std::vector<SurfaceGeometry> geometries_;
  base::Array<SurfaceGeometry> surfaces_;
  base::Mirrored<SurfacePose> poses_;
  std::vector<SurfacePose> listedAt_; ///< poses of the surfaces at the last list
  base::Mirrored<contact::PartLoad> surfaceSums_;
  base::FixedPoint surfaceForce_, surfaceTorque_;
  std::vector<SurfaceLoad> surfaceLoads_;
  double strongest_{};
  std::int64_t listings_{0};

  base::Array<std::uint32_t> near_; ///< slots
  int floorPlaces_;
  std::size_t springsWidth_;
  base::Array<float> springs_; ///< [list index][as in GrainKernelData::boundaryHistory]
  base::Array<base::Vec3d> fromSurfaces_;
  base::Array<BoundaryLoad<float>> singleLoads_;
  base::Array<BoundaryLoad<double>> doubleLoads_;
};

} // namespace grouser::terrain

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

/// Walls, floor and surfaces on the device, the list of grains near them, and the loads between them in a step.
class GrainBoundaries {
public:
  GrainBoundaries(const base::Exec& exec, const GrainConstants& constants, const Boundaries& boundaries);

  bool any() const { return count_ > 0; }
  bool hasSurfaces() const { return !geometries_.empty(); }

  /// Sets the poses of the surfaces for the next step, one per surface; the same on all ranks.
  void setSurfacePoses(const std::vector<SurfacePose>& poses);
  /// Loads of all grains on the surfaces in the last step: order-free sums, opposite to the loads on the grains.
  const std::vector<SurfaceLoad>& surfaceLoads() const { return surfaceLoads_; }

  std::span<const SurfacePose> surfacePoses() const { return {poses_.host(), geometries_.size()}; }
  double strongest() const { return strongest_; } ///< upper bound of the force of a contact with a surface [N]

  /// Whether the list of grains near surfaces must be rebuilt. Depends on the poses alone, so the same on all ranks.
  bool surfacesHaveLeft() const;
  /// Lists the grains that may touch a boundary before the next list, and those in touch with one; springs go along.
  /// `d`: of the grains in their present slots; `ghosts`: not 0 for those that need no list, null where there are none.
  void list(const GrainConstants& constants, const GrainKernelData& d, GrainArrays& arrays,
            const std::uint32_t* ghosts);
  std::size_t grainsListed() const { return near_.size(); }

  // Springs of walls, floor and surfaces: of the grains on the list alone, by their places there.

  std::size_t springsWidth() const { return springsWidth_; } ///< numbers a grain; 0 without friction
  const base::Array<float>& springs() const { return springs_; }
  /// Sets the springs of a loaded state: rows that the field boundaryOf counts from 1, until the next list.
  void setSprings(const std::vector<float>& springs) { springs_.assign(springs); }
  /// Copies the springs of the grains in `slots` (device array) for other ranks, one after the other.
  base::Array<float> exportSprings(const GrainFields& fields, const std::uint32_t* slots, std::size_t count) const;
  /// Room behind all springs for those of `count` grains that come from other ranks; null without friction.
  float* makeRoomForSprings(std::size_t count);
  /// Numbers the springs of the `count` slots starting at `first` after their arrival.
  void numberArrived(GrainFields& fields, std::size_t first, std::size_t count) const;

  std::int64_t listings() const { return listings_; } ///< made so far in scenes with surfaces

  // The loads of a step.
  void clearSurfaceLoads();                         ///< before the step, on the device
  void downloadSurfaceLoads();                      ///< after it, without waiting
  void collectSurfaceLoads(const base::Comm& comm); ///< sums over the ranks, after synchronize(); all ranks call it
  /// Loads of walls, floor and surfaces on a grain, by place in the list.
  template <class Real> BoundaryLoad<Real>* loads() {
    if constexpr (std::is_same_v<Real, float>)
      return singleLoads_.data();
    else
      return doubleLoads_.data();
  }

  /// The surface that a sphere [m] overlaps by more than `allowed` [m], and the overlap; empty if there is none.
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
  int count_;   ///< walls, floor and surfaces
  double room_; ///< that surfaces may move between two lists [m]

  base::Array<Wall> walls_;
  SearchedHeightField floor_;

  std::vector<SurfaceGeometry> geometries_;
  base::Array<SurfaceGeometry> surfaces_;
  base::Mirrored<SurfacePose> poses_;
  std::vector<SurfacePose> listedAt_; ///< the surfaces when the grains near them were listed
  base::Mirrored<contact::PartLoad> surfaceSums_;
  base::FixedPoint surfaceForce_, surfaceTorque_;
  std::vector<SurfaceLoad> surfaceLoads_;
  double strongest_{};
  std::int64_t listings_{0};

  base::Array<std::uint32_t> near_; ///< slots
  int floorPlaces_;
  std::size_t springsWidth_;
  base::Array<float> springs_; ///< [place in near_][as GrainKernelData::boundaryHistory says]
  base::Array<base::Vec3d> fromSurfaces_;
  base::Array<BoundaryLoad<float>> singleLoads_;
  base::Array<BoundaryLoad<double>> doubleLoads_;
};

} // namespace grouser::terrain

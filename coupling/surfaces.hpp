// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/ground_setup.hpp"
#include "coupling/ledger.hpp"
#include "coupling/mesh_contacts.hpp"
#include "coupling/pressed_grain.hpp"
#include "coupling/surface_state.hpp"
#include "terrain/grains.hpp"

#include <memory>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Response of meshes to grain impulses: prescribed motion, or one free axis.
class MovedMeshes : public contact::BodyResponse {
public:
  void begin(std::vector<terrain::SurfacePose> poses);
  const std::vector<std::uint32_t>& bodyOfPart() const override { return bodyOfPart_; }
  const std::vector<Inverse>& inverses() const override { return inverses_; }
  void respond(const std::vector<contact::BodyImpulse>& impulses,
               std::vector<contact::BodyVelocity>& velocities) override;

private:
  std::vector<terrain::SurfacePose> poses_; ///< poses at the start of the step
  std::vector<std::uint32_t> bodyOfPart_;
  std::vector<Inverse> inverses_;
};

/// Moving surfaces of a scene: poses at each step, drive loads, and motion of force-driven surfaces. Identical on all
/// ranks.
class Surfaces {
public:
  /// `setup` must outlive this object.
  Surfaces(const GroundSetup& setup, const base::Vec3d& gravity, double timeStep);
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  /// Creates the mesh contacts; call after grains are restored and before the first computeContacts().
  void makeMeshContacts(const base::Exec& exec, terrain::Grains& grains, SphereSets* kept);

  /// Computes contacts of grains with meshes in step `step`; complementarity contacts are part of the grain step.
  void computeContacts(const terrain::Grains& grains, std::int64_t step, bool slotsChanged);
  /// Contact moments of grains with meshes in step `step`, without side effects; empty without meshes.
  contact::PartMomentsView measure(const terrain::Grains& grains, std::int64_t step, bool slotsChanged);
  /// Loads for the grain step; null without meshes.
  const contact::GrainLoadsView* grainLoads() const { return meshes_ ? meshes_->grainLoads() : nullptr; }
  /// Sets the surface poses of the grains for step `step`.
  void place(terrain::Grains& grains, std::int64_t step) const;
  /// Adds the grain loads of step `step`, moves force-driven surfaces, and sets all poses for the next step. Throws
  /// SimulationError if a surface moves so fast that it could pass through a grain in one step, or reaches a periodic
  /// boundary, beyond which it has no contacts.
  void advance(terrain::Grains& grains, std::int64_t step);

  void setGravity(const base::Vec3d& gravity) { gravity_ = gravity; } ///< [m/s2]
  std::size_t count() const { return surfaces_.size(); }
  const SurfaceSetup& surface(std::size_t i) const { return surfaces_[i]; }
  base::Pose pose(std::size_t i, std::int64_t step) const;

  /// Grain loads about the centre, and power of the surface's drive: means since restartMeans().
  struct Observation {
    base::Vec3d force, torque; ///< [N], [N m]
    base::Vec3d pivotTorque;   ///< about the pivot [N m]
    double power{};            ///< [W]
    base::Vec3d position;      ///< current position of the centre [m]
  };
  Observation observe(std::size_t i, std::int64_t step) const;
  void restartMeans();
  /// Names of the meshes that overlap a grain, with the overlap [m]; collective.
  std::vector<std::pair<std::string, double>> meshesPressing(std::uint32_t grain) const;

  /// Ids of the grains crushed to their centre by a mesh in this step; collective.
  std::vector<std::uint32_t> endedGrains() const {
    return meshes_ ? meshes_->endedGrains() : std::vector<std::uint32_t>{};
  }
  std::vector<spheredecomp::CutReport> cutReports() const {
    return meshes_ ? meshes_->cutReports() : std::vector<spheredecomp::CutReport>{};
  }
  void takeOut(const std::vector<std::uint32_t>& grains) { meshes_->takeOut(grains); }
  std::optional<DeepestPartOverlap>
  deepestPartOverlap() const; ///< by a mesh since restartMeans(); empty without meshes

  /// Adds the work of drives, energies of force-driven surfaces, and contacts with meshes.
  void addTo(Ledger& ledger) const;
  double meshElastic() const { return meshes_ ? meshes_->ledger().elastic : 0.0; } ///< in contacts with meshes [J]

  SurfaceStates save() const;
  /// Throws InputError if the states belong to other surfaces.
  void restore(const SurfaceStates& states);

private:
  terrain::SurfacePose placement(std::size_t i, std::int64_t step) const;
  void checkPlace(std::size_t i, std::int64_t step) const;
  void checkSpeed(std::size_t i, std::int64_t step, double smallestRadius) const;

  std::vector<contact::PartMotion> meshMotions(std::int64_t step) const;
  base::Vec3d freeAxis(std::size_t i) const; ///< zero if the motion is prescribed

  const GroundSetup& setup_;
  const std::vector<SurfaceSetup>& surfaces_;
  base::Vec3d gravity_;
  double timeStep_;
  SurfaceStates states_;
  std::size_t shapes_{0}; ///< surfaces other than meshes
  std::unique_ptr<MeshContacts> meshes_;
  MovedMeshes movedMeshes_;
};

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/comm.hpp"
#include "base/exec.hpp"
#include "contact/subdomain.hpp"
#include "fluid/fluid_lists.hpp"
#include "fluid/fluid_setup.hpp"
#include "fluid/fluid_state.hpp"
#include "fluid/fluid_view.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace grouser::fluid {

/// Energies [J] (per metre in two dimensions), momentum, and losses since the start.
struct FluidTotals {
  double kinetic{}, potential{}, internal{}; ///< potential: zero at the origin
  double viscousLoss{}, diffusionLoss{}, wallLoss{};
  base::Vec3d momentum{};  ///< [kg m/s]
  base::Vec3d wallForce{}; ///< fluid on all markers, last step [N]
  double fastest{};        ///< greatest speed [m/s]
  double total() const { return kinetic + potential + internal + viscousLoss + diffusionLoss + wallLoss; }
};

/// Particles on the host, in the order of FluidSetup.
struct FluidSnapshot {
  std::vector<base::Vec3d> position, velocity; ///< [m], [m/s]
  std::vector<double> compression;             ///< [-]
};

/// A weakly compressible fluid of particles (smoothed particle hydrodynamics) between fixed walls: Wendland kernel,
/// density diffusion, walls by extrapolation, one sweep of forces a step.
///
/// A step: half a kick; half a drift; compression from the velocities at mid-step; half a drift; pressures of the
/// walls; forces; half a kick. Second order in time, but for diffusion, which is of first order. The
/// state is the same on any device and number of threads and ranks.
///
/// On several ranks each integrates the particles of its subdomain, and sends those near a border to others twice a
/// step. All ranks have all markers and bodies, and make the same calls.
class Fluid {
public:
  /// Throws InputError for values out of range.
  Fluid(const FluidSetup& setup, const base::Exec& exec, const contact::PartitionOptions& ranks = {});
  /// Continues from the state of save(), with the bodies of `setup`. Throws InputError if the state belongs to another
  /// fluid.
  Fluid(const FluidSetup& setup, const FluidState& state, const base::Exec& exec,
        const contact::PartitionOptions& ranks = {});
  FluidState save() const;

  /// `bodies`: motion of each over this step. Throws SimulationError if the speed, compression or distance of a
  /// particle exceeds its range, or a body moves too far in a step.
  void step(const std::vector<BodyMotion>& bodies = {});
  std::int64_t steps() const { return steps_; }
  double time() const { return static_cast<double>(steps_) * model_.timeStep; } ///< [s]

  const FluidModel& model() const { return model_; }
  std::size_t particles() const { return particles_; } ///< on all ranks together
  std::size_t markers() const { return markerForce_.size(); }
  FluidTotals totals();
  FluidSnapshot snapshot() const;
  /// State hash, the same on every device.
  std::uint64_t hash() const;
  /// Force of the fluid on each marker [N], in the order of FluidSetup.
  std::vector<base::Vec3d> markerForces() const;
  /// Loads of the fluid on the bodies at the end of the last step.
  std::vector<BodyLoad> bodyLoads() const;
  /// Pressure of the fluid at these points [Pa], extrapolated as to a marker at rest; 0 where no particle is near.
  std::vector<double> pressuresAt(const std::vector<base::Vec3d>& points);
  /// Levels at vertical wires that stand on `feet` [m]: the foot's z plus the length below `top` along which particles
  /// fill half of the kernel, without air gaps.
  std::vector<double> levelsAt(const std::vector<base::Vec3d>& feet, double top);
  /// Exact sum of the forces between particles and from walls, in quanta: zero.
  base::Vec3l forceBalance() const;
  std::int64_t rebuilds() const { return rebuilds_; } ///< neighbour lists made since the start
  std::int64_t bytesSent() const;                     ///< by this rank since the start

private:
  FluidView view();
  void placeBodies(double before);
  void advanceBodies(const std::vector<BodyMotion>& bodies);
  void rebuild();
  std::vector<std::uint32_t> divide(const std::vector<base::Position>& positions,
                                    const contact::PartitionOptions& ranks);
  template <class Visit> void eachOwned(const Visit& visit);
  const std::uint32_t* ghostMarks() const { return subdomain_ ? subdomain_->ghostMarks() : nullptr; }
  void migrate();
  void updateGhosts();
  void agreeOnSpeed();
  void agree();
  /// Records of all particles in the order of FluidSetup, on every rank.
  template <class T> std::vector<T> byId(const base::Array<T>& array) const;
  template <class T> void permute(base::Array<T>& array);
  void computeForces();
  void computeContinuity();
  void checkFlags();

  FluidModel model_;
  FluidConstants constants_;
  base::Exec exec_;
  double surfaceDivergence_;
  base::Comm comm_;
  bool rebalances_;
  std::unique_ptr<contact::Subdomain> subdomain_; ///< null on one rank
  std::size_t particles_, slots_{0};              ///< particles of all ranks; particles and ghosts of this one
  FluidLists lists_;
  base::Array<base::Position> position_, reference_;
  base::Array<base::Vec4f> motion_;
  base::Array<PreciseMotion> precise_;
  base::Array<base::Vec3l> force_;
  base::Array<CompressionChange> change_;
  base::Array<Losses> losses_;
  base::Array<base::Vec3d> shift_;         ///< empty without shifting
  base::Array<float> divergence_;          ///< empty without shifting
  base::Array<base::Vec3f> ghostVelocity_; ///< empty without laminar viscosity
  base::Array<base::Vec3l> markerForce_;
  std::uint32_t fixedMarkers_;
  std::vector<std::string> bodyName_;
  std::vector<double> bodyReach_; ///< greatest distance of a marker from the body's origin [m]
  double bodiesMoved_{0};         ///< upper bound since the lists were made [m]
  base::Mirrored<BodyMotion> body_;
  base::Array<std::uint32_t> bodyOf_;
  base::Array<float> bodyContact_;
  base::Array<base::Vec3d> bodyPoint_;
  base::Mirrored<BodyLoadQuanta> bodyLoad_;
  base::Array<std::uint32_t> id_;
  base::Mirrored<FluidFlags> flags_;
  std::int64_t steps_{0}, rebuilds_{0};
  bool listEnded_{true};
};

} // namespace grouser::fluid

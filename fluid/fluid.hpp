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

/// Energies [J] (in two dimensions per metre), momentum, and losses since the start.
struct FluidTotals {
  double kinetic{}, potential{}, internal{}; ///< potential: relative to the origin
  double viscousLoss{}, diffusionLoss{}, wallLoss{};
  base::Vec3d momentum{};  ///< [kg m/s]
  base::Vec3d wallForce{}; ///< fluid force on all markers in the last step [N]
  double fastest{};        ///< maximum speed [m/s]
  double total() const { return kinetic + potential + internal + viscousLoss + diffusionLoss + wallLoss; }
};

/// Particles on the host, in the order of FluidSetup.
struct FluidSnapshot {
  std::vector<base::Vec3d> position, velocity; ///< [m], [m/s]
  std::vector<double> compression;             ///< [-]
};

/// Weakly compressible fluid of particles (smoothed particle hydrodynamics) between fixed walls: Wendland kernel,
/// density diffusion, wall pressure by extrapolation, one force evaluation per step.
///
/// Sequence of a step: half kick; half drift; compression from the mid-step velocities; half drift; wall pressures;
/// forces; half kick. Second order in time, except for the diffusion, which is first order. The state is bitwise
/// identical on any device and for any number of threads and ranks.
///
/// On several ranks each rank integrates the particles of its subdomain, and sends those near a border to other ranks
/// twice per step. All ranks have all markers and bodies; all members are collective.
class Fluid {
public:
  /// Throws InputError for values out of range.
  Fluid(const FluidSetup& setup, const base::Exec& exec, const contact::PartitionOptions& ranks = {});
  /// Restores the state returned by save(), with the bodies of `setup`. Throws InputError if the state belongs to
  /// another fluid.
  Fluid(const FluidSetup& setup, const FluidState& state, const base::Exec& exec,
        const contact::PartitionOptions& ranks = {});
  FluidState save() const;

  /// Advances one step. `bodies`: motion of each body over this step. Throws SimulationError if the speed, compression
  /// or distance of a particle is out of range, or a body moves too far in a step.
  void step(const std::vector<BodyMotion>& bodies = {});
  std::int64_t steps() const { return steps_; }
  double time() const { return static_cast<double>(steps_) * model_.timeStep; } ///< [s]

  const FluidModel& model() const { return model_; }
  std::size_t particles() const { return particles_; } ///< total over all ranks
  std::size_t markers() const { return markerForce_.size(); }
  FluidTotals totals();
  FluidSnapshot snapshot() const;
  /// State hash, identical on every device.
  std::uint64_t hash() const;
  /// Fluid force on each marker [N], in the order of FluidSetup.
  std::vector<base::Vec3d> markerForces() const;
  /// Fluid loads on the bodies at the end of the last step.
  std::vector<BodyLoad> bodyLoads() const;
  /// Fluid pressure at these points [Pa], extrapolated as for a marker at rest; 0 without particles nearby.
  std::vector<double> pressuresAt(const std::vector<base::Vec3d>& points);
  /// Water levels at vertical wave gauges with their lower ends at `feet` [m]: the z of the foot plus the length below
  /// `top` along which particles fill at least half of the kernel, without air gaps.
  std::vector<double> levelsAt(const std::vector<base::Vec3d>& feet, double top);
  /// Exact sum of particle-particle and wall forces in quanta; must be zero.
  base::Vec3l forceBalance() const;
  std::int64_t rebuilds() const { return rebuilds_; } ///< neighbour lists built since the start
  std::int64_t bytesSent() const;                     ///< sent by this rank since the start

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
  std::unique_ptr<contact::Subdomain> subdomain_; ///< null on a single rank
  std::size_t particles_, slots_{0};              ///< particles of all ranks; particles and ghosts of this rank
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
  std::vector<double> bodyReach_; ///< maximum distance of a marker from the body's origin [m]
  double bodiesMoved_{0};         ///< upper bound of the body motion since the lists were built [m]
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

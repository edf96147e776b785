// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/fluid_domain_setup.hpp"
#include "fluid/fluid.hpp"
#include "multibody/model.hpp"
#include "multibody/state.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::coupling {

/// Fluid of a simulation and its coupling with rigid bodies.
///
/// A fluid step spans one or several steps of the bodies (FluidDomainSetup::stepsPerStep), since contacts of a vehicle
/// need shorter steps than a fluid. Loads on bodies are those at the start of a fluid step, as for all contacts; the
/// fluid receives the opposite integers in two half kicks, at the start and end of its step.
///
/// Marker pressures depend on the acceleration of their body, which depends on these pressures (added mass). With the
/// acceleration of the last step, this loop has the gain M_g / m (ghost inertia / mass) and diverges for gains above 1.
/// Relaxation by 1 / (1 + gain) makes it converge for any gain; a constant acceleration is exact in the limit.
class FluidDomain {
public:
  /// `model`, `bodies`: null without bodies; `former`: saved state to resume, or null. Throws base::InputError if
  /// `former` belongs to another scene. `setup` must outlive this object.
  FluidDomain(const FluidDomainSetup& setup, const multibody::Model* model, const multibody::State* bodies,
              const base::Exec& exec, const base::Comm& comm = {}, const FluidDomainState* former = nullptr);
  FluidDomainState save() const;

  /// Adds the fluid loads on the bodies at their current poses. Returns the sum of their forces [N].
  base::Vec3d addLoads(multibody::Loads& loads) const;
  /// Advances one step of the simulation, with the bodies now at `bodies`; null without bodies. Every stepsPerStep-th
  /// call advances the fluid.
  void advance(const multibody::State* bodies);

  const fluid::Fluid& fluid() const { return fluid_; }
  std::vector<fluid::BodyLoad> bodyLoads() const { return fluid_.bodyLoads(); } ///< [N], [N m] about the centre of mass
  /// Output columns (BodyInFluid::column), in the order of their first bodies.
  const std::vector<std::string>& columns() const { return columns_; }
  /// Sum of the loads of each column, with torques about the current centres of mass of BodyInFluid::about.
  std::vector<fluid::BodyLoad> columnLoads(const multibody::State* bodies) const;
  /// Totals after the last step, computed at the first call.
  const fluid::FluidTotals& totals();

  /// Probe values, in the order of the setup [Pa], [m].
  std::vector<double> probe();

private:
  struct Follower {
    std::size_t body, about, column;
    double relaxation;                                 ///< 1 / (1 + gain) [-]
    multibody::Twist before, sum{};                    ///< twist at the last fluid step; sum over the steps since
    base::Vec3d acceleration{}, angularAcceleration{}; ///< relaxed [m/s2], [rad/s2]
  };
  fluid::FluidSetup withBodies(const multibody::Model* model, const multibody::State* bodies,
                               const FluidDomainState* former);
  fluid::BodyMotion motionOf(const Follower& f, const multibody::State& state, const multibody::Twist& mean) const;

  const FluidDomainSetup& setup_;
  std::vector<Follower> followers_;
  std::vector<std::string> columns_;
  fluid::Fluid fluid_;
  std::int64_t waited_{0};                   ///< simulation steps since the last fluid step
  std::optional<fluid::FluidTotals> totals_; ///< empty until requested after a step
};

} // namespace grouser::coupling

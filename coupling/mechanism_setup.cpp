// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/mechanism_setup.hpp"

#include <algorithm>

namespace grouser::coupling {

namespace {

/// Joint opening speed above which initial velocities count as rounded input, and are corrected [m/s].
constexpr double kRoundedRate = 1e-12;

} // namespace

double beginMotion(const MechanismSetup& setup, multibody::Solver& solver, multibody::State& state,
                   multibody::Loads& loads) {
  loads.gravity = setup.gravity;
  const bool imposed = std::any_of(setup.model.drives().begin(), setup.model.drives().end(),
                                   [](const multibody::Drive& d) { return d.kind != multibody::DriveKind::kForce; });
  if (!imposed && solver.velocityError(state) <= kRoundedRate) return 0;
  return -solver.projectVelocities(state, loads);
}

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/mechanism_setup.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::coupling {

namespace {

/// Velocities that open joints faster than this at the start were typed with a few digits, and are made to fit [m/s].
constexpr double kRoundedRate = 1e-12;

} // namespace

ContactParts contactPartsOf(const MechanismSetup& setup) {
  ContactParts all;
  const std::vector<multibody::Body>& bodies = setup.model.bodies();
  for (const BodyShape& s : setup.shapes)
    all.parts.push_back({.name = fmt::format("body \"{}\"", bodies[s.body].name),
                         .body = s.body,
                         .pose_B = s.pose_B,
                         .surface = -1,
                         .shape = s.shape,
                         .material = s.material,
                         .reach = norm(halfExtent(s.shape)) + norm(s.pose_B.position),
                         .shown = s.body});
  for (const multibody::Body& body : bodies)
    if (!body.fixed) all.weight += body.mass * kLoadScale;
  all.weight = std::max(all.weight, 1.0); // fixed bodies have no mass, but loads need a scale
  return all;
}

double beginMotion(const MechanismSetup& setup, multibody::Solver& solver, multibody::State& state,
                   multibody::Loads& loads) {
  loads.gravity = setup.gravity;
  const bool imposed = std::any_of(setup.model.drives().begin(), setup.model.drives().end(),
                                   [](const multibody::Drive& d) { return d.kind != multibody::DriveKind::kForce; });
  if (!imposed && solver.velocityError(state) <= kRoundedRate) return 0;
  return -solver.projectVelocities(state, loads);
}

} // namespace grouser::coupling

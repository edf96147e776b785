// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene.hpp"

#include <string>

namespace grouser::runs {

/// Duration [s] of the shortest contact between two grains of the scene's bed: pi / sqrt(k / m_eff), undamped, of the
/// stiffest law and the lightest grain (linear spring; the damped one lasts longer). 0 where there are no grains.
double shortestContact(const Scene& scene);

/// Steps that a contact should last at least: at 20 steps a collision's restitution is right within 2 %.
inline constexpr double kStepsPerContact = 20;

/// What the scene switches on and leaves out, its size, time step, memory and cost. Reads the height-map's file not.
std::string planText(const Scene& scene);

} // namespace grouser::runs

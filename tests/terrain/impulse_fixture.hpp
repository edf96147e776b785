// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grain_fixture.hpp"

namespace grouser::terrain::testing {

/// Gravel in steps of a millisecond, solved to a hundredth of the gravity increment of one step.
inline GrainModel impulsiveGravel(contact::Compliance compliance, double skin = 0.3) {
  GrainModel m = gravel(skin);
  m.timeStep = 1e-3;
  contact::ComplementarityOptions o;
  o.compliance = compliance, o.recovery = 0.1, o.iterations = 80;
  o.residual = 0.01 * 9.81 * m.timeStep, o.impact = 5 * 9.81 * m.timeStep;
  m.complementarity = o;
  m.law.restitution = 0.3;
  return m;
}

} // namespace grouser::terrain::testing

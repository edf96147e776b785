// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/cases.hpp"

#include <optional>
#include <string>
#include <vector>

/// Error against run time of the multibody solver (work-precision), for mechanisms whose motion is known.
namespace grouser::studies {

struct IntegratorChoice {
  std::string name; ///< "euler", "rattle2"
  std::string word; ///< run.integrator
  int order = 1;    ///< run.integrator_order
};
std::vector<IntegratorChoice> studyIntegrators();

/// One run of a case.
struct StudyPoint {
  std::string integrator;
  double step = 0; ///< [s]
  std::int64_t steps = 0;
  /// Root mean square over all probes and times of |y - y_ref| / max(|y_ref|, 1e-3) [-] (Gonzalez, Dopico, Lugris and
  /// Cuadrado 2006, Multibody System Dynamics 16:179). Empty: the run failed, or would have taken too long.
  std::optional<double> error;
  double order = 0;         ///< log2 of the errors' ratio over that of the steps, against the step before; NaN: none
  double positionDrift = 0; ///< widest gap of a joint [m, rad]
  double velocityDrift = 0; ///< fastest opening of a joint at the times compared [m/s, rad/s]
  double energyDrift = 0;   ///< of kinetic + potential + elastic + dissipated - drive work, the largest [J]
  double seconds = 0;       ///< CPU time of the steps
  std::string failure;      ///< why there is no error
};

/// Runs a case over `count` steps, each a quarter of the one before. What is expected to take more than `budget`
/// seconds of CPU is left out.
std::vector<StudyPoint> studyOne(const StudyCase& c, const IntegratorChoice& integrator, int count, double budget);

struct ReactionResult {
  ReactionCase reaction;
  std::string integrator;
  std::optional<double> mean; ///< [N] over all steps
  double worst = 0;           ///< largest deviation after the first step, over the exact value [-]
  std::string failure;
};
/// Runs a mechanism whose reaction is known in closed form, and compares it in every step.
ReactionResult measureReaction(const ReactionCase& r, const IntegratorChoice& integrator);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/cases.hpp"

#include <optional>
#include <string>
#include <vector>

/// Error of the multibody solver over run time (work-precision) for mechanisms with known motion.
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
  /// Root mean square of |y - y_ref| / max(|y_ref|, 1e-3) [-] over all probes and times (Gonzalez, Dopico, Lugris and
  /// Cuadrado 2006, Multibody System Dynamics 16:179). Empty: the run failed, or was skipped because it takes too long.
  std::optional<double> error;
  double order = 0;         ///< observed order between the previous step size and this one; NaN: unknown
  double positionDrift = 0; ///< maximum joint position error [m, rad]
  double velocityDrift = 0; ///< maximum joint velocity error at the sample times [m/s, rad/s]
  double energyDrift = 0;   ///< maximum change of kinetic + potential + elastic + dissipated - drive work [J]
  double seconds = 0;       ///< CPU time of the steps
  std::string failure;      ///< reason why `error` is empty
};

/// Runs a case with `count` step sizes, each a quarter of the previous one. Skips runs with an expected CPU time above
/// `budget` [s].
std::vector<StudyPoint> studyOne(const StudyCase& c, const IntegratorChoice& integrator, int count, double budget);

struct ReactionResult {
  ReactionCase reaction;
  std::string integrator;
  std::optional<double> mean; ///< mean over all steps [N]
  double worst = 0;           ///< maximum deviation after the first step / exact value [-]
  std::string failure;
};
/// Runs a mechanism, and compares a reaction force with its closed form in each step.
ReactionResult measureReaction(const ReactionCase& r, const IntegratorChoice& integrator);

} // namespace grouser::studies

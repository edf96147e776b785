// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/cases.hpp"

#include <optional>
#include <string>
#include <vector>

/// Error over run time of the multibody solver (work-precision) for mechanisms with known motion.
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
  /// Cuadrado 2006, Multibody System Dynamics 16:179). Empty: the run failed, or was skipped as too long.
  std::optional<double> error;
  double order = 0;         ///< observed order relative to the previous step; NaN: none
  double positionDrift = 0; ///< maximum joint position error [m, rad]
  double velocityDrift = 0; ///< maximum joint velocity error at the compared times [m/s, rad/s]
  double energyDrift = 0;   ///< maximum of kinetic + potential + elastic + dissipated - drive work [J]
  double seconds = 0;       ///< CPU time of the steps
  std::string failure;      ///< reason if there is no error
};

/// Runs a case with `count` step sizes, each a quarter of the previous one. Skips runs that are expected to take more
/// than `budget` seconds of CPU time.
std::vector<StudyPoint> studyOne(const StudyCase& c, const IntegratorChoice& integrator, int count, double budget);

struct ReactionResult {
  ReactionCase reaction;
  std::string integrator;
  std::optional<double> mean; ///< [N] over all steps
  double worst = 0;           ///< maximum deviation after the first step / exact value [-]
  std::string failure;
};
/// Runs a mechanism with a closed form of a reaction and compares it in each step.
ReactionResult measureReaction(const ReactionCase& r, const IntegratorChoice& integrator);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/scene/scene.hpp"
#include "runs/validation/studies/random_scenes.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Compares the automatic step and the step limit of `grouser run` with the longest stable step of random scenes.
namespace grouser::studies {

/// A run of a scene at one step size.
struct StepTrial {
  double step = 0;      ///< [s]
  bool blewUp = false;  ///< kinetic + potential + elastic energy grew by kRandomGrowth of its initial value; or a grain
                        ///< exceeded kRandomSpeed times the maximum physical speed or overlapped too much; or NaN
  bool alarmed = false; ///< the run blew up, or the energy check raised an alarm
  double growth = 0;    ///< maximum energy gain / initial energy [-]
  std::string why;      ///< first message; empty if the run is sound
};
inline constexpr double kRandomGrowth = 0.5, kRandomSpeed = 2.5;

/// Runs the scene for the fraction `share` of its duration, at a step that is not checked.
StepTrial tryStep(const RandomScene& random, const scene::Scene& scene, double step, double share = 1);

/// Steps of a scene: automatic steps, step limit, and longest sound steps.
struct StepMargins {
  RandomScene scene;
  double contact = 0;   ///< shortest contact time [s]
  double limit = 0;     ///< longest step that a run allows [s]
  std::string limiting; ///< contact that determines the limit, e.g. "grain on the floor"
  double automatic = 0; ///< "auto" with the default run.steps_per_contact [s]
  double coarse = 0;    ///< "auto" with the minimum run.steps_per_contact [s]
  StepTrial atAutomatic, atCoarse, atLimit;
  double bounded = 0; ///< longest step without blow-up [s]
  double silent = 0;  ///< longest step without an alarm [s]
};

/// Runs the scene at its automatic steps and at its limit, then searches for the longest sound steps with the relative
/// accuracy `accuracy`: increases the step from the limit by factors of 1.5 until it is unsound, then bisects.
StepMargins stepMargins(const RandomScene& random, double accuracy, double share = 1);

std::string marginsHeader();                                                    ///< header of the CSV
std::string marginsLine(const StepMargins& m);                                  ///< line of the CSV without newline
std::string marginsSummary(const std::vector<std::string>& lines, bool& sound); ///< summary of lines of the CSV

struct RandomStability {
  int scenes = 0; ///< number of scenes; 0: do not run this study
  std::int64_t seed = 1;
  bool resume = false;
};

/// `grouser study stability --random N`. Throws base::SimulationError, after writing all files, if a scene raises an
/// alarm at its automatic step or blows up at its step limit.
void studyRandomStability(const RandomStability& command, const jobs::StudyPlace& place);

} // namespace grouser::studies

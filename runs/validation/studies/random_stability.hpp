// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/scene/scene.hpp"
#include "runs/validation/studies/random_scenes.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// How the steps that `grouser run` chooses and allows compare with the longest at which a scene is stable: random
/// scenes, each run at steps above its limit too.
namespace grouser::studies {

/// A run of a scene at one step, sound or not.
struct StepTrial {
  double step = 0;      ///< [s]
  bool blewUp = false;  ///< kinetic, potential and elastic energy grew by kRandomGrowth of what there was at the start,
                        ///< a grain got kRandomSpeed times as quick as any could be, or too deep, or no number
  bool alarmed = false; ///< that, or the run's energy guard raised an alarm
  double growth = 0;    ///< largest gain of energy over that at the start [-]
  std::string why;      ///< the first message; empty where all is sound
};
inline constexpr double kRandomGrowth = 0.5, kRandomSpeed = 2.5;

/// The scene at a step that nobody checks; `share` of its duration.
StepTrial tryStep(const RandomScene& random, const scene::Scene& scene, double step, double share = 1);

/// What a scene is given and what it could bear.
struct StepMargins {
  RandomScene scene;
  double contact = 0;   ///< its shortest [s]
  double limit = 0;     ///< longest step that a run takes [s]
  std::string limiting; ///< "grain on the floor"
  double automatic = 0; ///< with run.steps_per_contact as it is without being given [s]
  double coarse = 0;    ///< "auto" with the fewest steps a contact [s]
  StepTrial atAutomatic, atCoarse, atLimit;
  double bounded = 0; ///< longest step found at which it does not blow up [s]
  double silent = 0;  ///< at which there is no alarm either [s]
};

/// Runs the scene at its automatic steps and at its limit, then looks for the longest sound ones, to `accuracy` of them
/// [-]: upwards from the limit by factors of 1.5 to the first that is unsound, then by bisection.
StepMargins stepMargins(const RandomScene& random, double accuracy, double share = 1);

std::string marginsHeader();                                                    ///< of the CSV
std::string marginsLine(const StepMargins& m);                                  ///< without the line's end
std::string marginsSummary(const std::vector<std::string>& lines, bool& sound); ///< of such lines

struct RandomStability {
  int scenes = 0; ///< 0: not asked for
  std::int64_t seed = 1;
  bool resume = false;
};

/// `grouser study stability --random N`. Throws base::SimulationError, after all is written, where a scene raises an
/// alarm at the step that a run chooses or blows up at the longest that it takes.
void studyRandomStability(const RandomStability& command, const jobs::StudyPlace& place);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/scene/scene.hpp"
#include "runs/validation/studies/random_scenes.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Automatic step and step limit of `grouser run` against the longest stable step of random scenes.
namespace grouser::studies {

/// A run of a scene at one step.
struct StepTrial {
  double step = 0;      ///< [s]
  bool blewUp = false;  ///< kinetic + potential + elastic energy grew by kRandomGrowth of its initial value,
                        ///< a grain exceeded kRandomSpeed times the physical maximum, or overlapped too much, or NaN
  bool alarmed = false; ///< blow-up, or an alarm of the energy guard
  double growth = 0;    ///< maximum energy gain / initial energy [-]
  std::string why;      ///< first message; empty if sound
};
inline constexpr double kRandomGrowth = 0.5, kRandomSpeed = 2.5;

/// The scene at an unchecked step for `share` of its duration.
StepTrial tryStep(const RandomScene& random, const scene::Scene& scene, double step, double share = 1);

/// Steps of a scene: automatic, limit, and longest sound ones.
struct StepMargins {
  RandomScene scene;
  double contact = 0;   ///< shortest contact time [s]
  double limit = 0;     ///< longest step allowed by a run [s]
  std::string limiting; ///< "grain on the floor"
  double automatic = 0; ///< "auto" with the default run.steps_per_contact [s]
  double coarse = 0;    ///< "auto" with the minimum run.steps_per_contact [s]
  StepTrial atAutomatic, atCoarse, atLimit;
  double bounded = 0; ///< longest step without blow-up [s]
  double silent = 0;  ///< longest step without alarm [s]
};

/// Runs the scene at its automatic steps and at its limit, then searches the longest sound steps with relative
/// accuracy `accuracy`: upwards from the limit by factors of 1.5 to the first unsound step, then by bisection.
StepMargins stepMargins(const RandomScene& random, double accuracy, double share = 1);

std::string marginsHeader();                                                    ///< header of the CSV
std::string marginsLine(const StepMargins& m);                                  ///< without newline
std::string marginsSummary(const std::vector<std::string>& lines, bool& sound); ///< summary of such lines

struct RandomStability {
  int scenes = 0; ///< 0: off
  std::int64_t seed = 1;
  bool resume = false;
};

/// `grouser study stability --random N`. Throws base::SimulationError, after writing all files, if a scene raises an
/// alarm at its automatic step or blows up at its step limit.
void studyRandomStability(const RandomStability& command, const jobs::StudyPlace& place);

} // namespace grouser::studies

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/campaigns/forecast/counted_grains.hpp"
#include "runs/campaigns/forecast/probe.hpp"
#include "runs/scene/scene.hpp"
#include "spheredecomp/protrusion.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// How long a run will take on this machine, told by a second of its kind of work.
namespace grouser::forecast {

/// One part of a run's time.
struct ForecastPart {
  std::string name;
  double seconds = 0; ///< wall time [s]
  std::string how;    ///< what it was reckoned from
};

struct Forecast {
  std::vector<ForecastPart> preparation, steps, output;
  std::string warning;                       ///< problem with the bed; empty: none
  double spent = 0;                          ///< by the probe itself [s]
  double process = 0;                        ///< most memory of the process [B]
  double device = 0;                         ///< GPU memory [B]; 0 on a CPU
  double disk = 0;                           ///< disk space of the results [B]
  double diskSpeed = 0;                      ///< at which frames and checkpoints were written [B/s]; 0: not measured
  std::string onDevice;                      ///< in words
  std::vector<spheredecomp::CutReport> cuts; ///< cuts of parts and meshes of the run

  static double sum(const std::vector<ForecastPart>& parts);
  double total() const { return sum(preparation) + sum(steps) + sum(output); } ///< [s]
};

struct ForecastOptions {
  std::filesystem::path folder; ///< that results would go to: its disk is the one that is measured
  double seconds = 1;           ///< for steps
  bool cache = true;            ///< beds and sphere sets may be taken from earlier runs, as a run does
};

/// Makes a piece of the scene's work and runs it: its bed, where one is kept, or copies of a small settled tile of the
/// same grains, with the scene's vehicle, mechanism or surfaces on it; some rows, frames and a checkpoint in a folder
/// of its own that is removed again. Sphere sets that are cut for it are kept for the run. Throws what a run throws
/// before its first step; where the steps of the probe fail, `warning` says so.
Forecast forecastOf(const scene::Scene& scene, const CountedGrains& counted, const ForecastOptions& options);

/// The figures as `grouser plan` prints them.
std::string forecastText(const Forecast& forecast);
/// The same for programs: seconds of all parts by name, bytes, machine and commit.
std::string forecastJson(const Forecast& forecast);

} // namespace grouser::forecast

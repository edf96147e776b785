// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/campaigns/forecast/counted_grains.hpp"
#include "runs/campaigns/forecast/probe.hpp"
#include "runs/scene/scene.hpp"
#include "spheredecomp/protrusion.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// A short or long probe of a scene predicts the run time on this machine.
namespace grouser::forecast {

/// Origin of a figure: measured for this scene now, in an earlier probe on this machine, or on other machines.
enum class Source { probed, kept, typical };

/// One part of a run's time.
struct ForecastPart {
  std::string name;
  double seconds = 0; ///< wall time [s]
  std::string how;    ///< basis of the estimate
  Source source = Source::probed;
};

struct Forecast {
  std::vector<ForecastPart> preparation, steps, output;
  std::string warning;                       ///< why there is no run-time estimate; empty: none
  double spent = 0;                          ///< by the probe itself [s]
  bool probed = true;                        ///< by the long probe
  double process = 0;                        ///< most memory of the process [B]
  double device = 0;                         ///< GPU memory [B]; 0 on a CPU
  double disk = 0;                           ///< disk space of the results [B]
  double diskSpeed = 0;                      ///< at which frames and checkpoints were written [B/s]; 0: not measured
  std::string onDevice;                      ///< in words
  std::vector<spheredecomp::CutReport> cuts; ///< cuts of parts and meshes of the run

  static double sum(const std::vector<ForecastPart>& parts);
  double total() const { return sum(preparation) + sum(steps) + sum(output); } ///< [s]

  /// Parts are accurate within such a factor [-].
  double accuracy(Source source) const;
  /// The total if all parts were `sign` = -1 shorter or 1 longer by their factors [s].
  double bound(int sign) const;
};

struct ForecastOptions {
  std::filesystem::path folder; ///< that results would go to: its disk is the one that is measured
  double seconds = 1;           ///< for steps of the long probe
  bool cache = true;            ///< beds and sphere sets may be taken from earlier runs, as a run does
  bool probe = true;            ///< the long probe; false: a second at most
  std::function<void(const char*)> stage = [](const char*) {}; ///< called with the name of each stage
};

/// The long probe makes a piece of the scene's work and runs it: its bed, where one is kept, or copies of a small
/// settled tile of the same grains, with the scene's vehicle, mechanism or surfaces on it; some rows, frames and a
/// checkpoint in a folder of its own that is removed again. Sphere sets that are cut for it are cached for the run.
/// Throws what a run throws before its first step; where the steps of the probe fail, `warning` says so. What it
/// measures is saved for later plans (with `cache`). Without it a small tile of the bed, or a scene of few grains, is
/// run for less than a second; all else follows from figures that long probes on this machine have kept, else from
/// typical values.
Forecast forecastOf(const scene::Scene& scene, const CountedGrains& counted, const ForecastOptions& options);

/// The figures as `grouser plan` prints them.
std::string forecastText(const Forecast& forecast);
/// The same for programs: seconds of all parts by name, bytes, machine and commit.
std::string forecastJson(const Forecast& forecast);

} // namespace grouser::forecast

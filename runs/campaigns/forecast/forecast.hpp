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

/// Prediction of the run time on this machine by a short or long probe of a scene.
namespace grouser::forecast {

/// Origin of a time: measured now for this scene, measured by an earlier probe on this machine, or typical.
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
  std::string warning;                       ///< reason for a missing run-time estimate; else empty
  double spent = 0;                          ///< duration of the probe [s]
  bool probed = true;                        ///< whether the long probe ran
  double process = 0;                        ///< peak memory of the process [B]
  double device = 0;                         ///< GPU memory [B]; 0 on a CPU
  double disk = 0;                           ///< disk space of the results [B]
  double checkpoint = 0;                     ///< size of checkpoint.h5 [B]
  double diskSpeed = 0;                      ///< write speed of frames and checkpoints [B/s]; 0: not measured
  std::string onDevice;                      ///< description of the device
  std::vector<spheredecomp::CutReport> cuts; ///< reports on the sphere sets of parts and meshes

  static double sum(const std::vector<ForecastPart>& parts);
  double total() const { return sum(preparation) + sum(steps) + sum(output); } ///< [s]

  /// Factor within which times of this origin are accurate [-].
  double accuracy(Source source) const;
  /// Total [s] if all parts are shorter (`sign` = -1) or longer (1) by their factors.
  double bound(int sign) const;
};

struct ForecastOptions {
  std::filesystem::path folder;                                ///< results folder; the probe measures its disk
  double seconds = 1;                                          ///< wall time of the steps of the long probe [s]
  bool cache = true;                                           ///< use cached beds and sphere sets, as a run does
  bool probe = true;                                           ///< long probe; false: short probe, at most a second
  std::function<void(const char*)> stage = [](const char*) {}; ///< called with the name of each stage
};

/// The long probe runs a part of the scene: the cached bed, or copies of a small settled tile of the same grains, with
/// vehicle, mechanism or surfaces. It writes rows, frames and a checkpoint into a temporary folder and caches the
/// sphere sets for the run. Throws the same errors as a run before its first step; `warning` reports failed steps. With
/// `cache`, times are stored for later plans. The short probe runs a small tile of the bed, or a scene of few grains,
/// for less than a second; other times follow from stored long probes on this machine, or else from typical values.
Forecast forecastOf(const scene::Scene& scene, const CountedGrains& counted, const ForecastOptions& options);

/// Text of the forecast for `grouser plan`.
std::string forecastText(const Forecast& forecast);
/// Forecast as JSON: time of each part by name [s], memory and disk space [bytes], machine and commit.
std::string forecastJson(const Forecast& forecast);

} // namespace grouser::forecast

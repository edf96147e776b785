// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "runs/scene/scene.hpp"
#include "runs/storage/bed_cache.hpp"
#include "runs/storage/sphere_cache.hpp"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

/// One run of a vehicle for the stability maps, and its figures.
namespace grouser::studies {

/// A changed key of the vehicle file: {"shoe", "mass", "0.85"}.
struct SpecChange {
  std::string section, key, value;
};

/// A scene of the shipped vehicle, or with its own vehicle.spec.
struct VehicleCase {
  std::string scene;       ///< TOML without run.time_step and vehicle.spec; ends with the section [vehicle]
  bool ownVehicle = false; ///< the scene sets vehicle.spec; no `changes`
  std::string run;         ///< further keys of [run]
  std::vector<SpecChange> changes;
  double from = 0, until = 0; ///< window of the compared means [s]; the run ends with it
};

/// Means over the window unless stated otherwise; until the stop for stopped runs.
struct MapFigures {
  double speed = NAN;            ///< hull speed along x [m/s]
  double height = NAN;           ///< height of the hull's centre of mass [m]
  double lowest = NAN;           ///< minimum of this height since the start [m]
  double pitch = NAN;            ///< hull pitch, nose up [rad]
  double power = NAN;            ///< power of the drives [W]
  double tension = NAN;          ///< track tension, over all steps [N]
  double sinkage = NAN;          ///< sinkage of the loaded shoes [m]
  double dissipated = NAN;       ///< energy dissipated in the whole run [J]
  double integrationError = NAN; ///< integration error of the whole run [J]
  double turnover = NAN;         ///< absolute work of the whole run [J]
  double energyResidual = NAN;   ///< energy residual of the whole run / turnover [-]: rounding
  double speedMagnitude = NAN;   ///< mean of |speed| [m/s]
  double powerMagnitude = NAN;   ///< mean of |power of the drives| [W]
  double blow = NAN;             ///< largest impact of the whole run, as in the warning of a run [weights]
};

enum class TrialEnd { sound, stopped, refused };

struct VehicleTrial {
  double step = 0; ///< [s]
  TrialEnd end = TrialEnd::sound;
  std::string cause;    ///< error message; empty for sound runs
  base::Cause blamed{}; ///< cause of the error
  double reached = 0;   ///< simulated time reached [s]
  double wallSeconds = 0;
  MapFigures figures;
};

/// Folders and caches of trials.
struct TrialPlace {
  std::filesystem::path folder; ///< folder of the vehicle file
  storage::BedCache* beds = nullptr;
  storage::SphereCache* spheres = nullptr;
  base::Exec exec = base::cpuExec(1);
};

/// Whether the step limit is checked before the run.
enum class StepCheck { asForUsers, none };

/// Text of the scene at this step [s]; 0: automatic. Without vehicle.spec unless it is its own.
std::string sceneText(const VehicleCase& what, double step);

/// The scene at this step. Writes its vehicle file to `folder`. Throws InputError if the scene is rejected.
scene::Scene sceneOf(const VehicleCase& what, double step, const std::filesystem::path& folder,
                     StepCheck check = StepCheck::asForUsers);

/// The longest step allowed by the program: stable contacts, resolved oscillations and rotations [s].
double longestStep(const VehicleCase& what, const std::filesystem::path& folder);

/// Runs it to the end of its window. Throws only if the program is asked to stop.
VehicleTrial tryVehicle(const VehicleCase& what, double step, const TrialPlace& place,
                        StepCheck check = StepCheck::asForUsers);

} // namespace grouser::studies

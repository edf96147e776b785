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

/// A run of a vehicle for the stability maps, and its figures (results that are compared).
namespace grouser::studies {

/// A changed key of the vehicle file: {"shoe", "mass", "0.85"}.
struct SpecChange {
  std::string section, key, value;
};

/// A scene with the vehicle light_tracked, or a scene that sets vehicle.spec.
struct VehicleCase {
  std::string scene;       ///< TOML without run.time_step and vehicle.spec; ends with the section [vehicle]
  bool ownVehicle = false; ///< the scene sets vehicle.spec, and `changes` is empty
  std::string run;         ///< further keys of [run]
  std::vector<SpecChange> changes;
  double from = 0, until = 0; ///< window of the compared means [s]; the run ends at `until`
};

/// Means over the window (until the stop for stopped runs), unless stated otherwise.
struct MapFigures {
  double speed = NAN;            ///< hull speed along x [m/s]
  double height = NAN;           ///< height of the hull's centre of mass [m]
  double lowest = NAN;           ///< minimum of the height since the start [m]
  double pitch = NAN;            ///< hull pitch, nose up [rad]
  double power = NAN;            ///< power of the drives [W]
  double tension = NAN;          ///< track tension, mean over all steps in the window [N]
  double sinkage = NAN;          ///< sinkage of the loaded shoes [m]
  double dissipated = NAN;       ///< energy dissipated in the whole run [J]
  double integrationError = NAN; ///< integration error of the whole run [J]
  double turnover = NAN;         ///< absolute work (energy turnover) of the whole run [J]
  double energyResidual = NAN;   ///< energy residual of the whole run / turnover [-]; caused by rounding
  double speedMagnitude = NAN;   ///< mean of |speed| [m/s]
  double powerMagnitude = NAN;   ///< mean of |power of the drives| [W]
  double blow = NAN;             ///< largest impact of the whole run, as in the warning of a run [vehicle weights]
};

enum class TrialEnd { sound, stopped, refused };

struct VehicleTrial {
  double step = 0; ///< [s]
  TrialEnd end = TrialEnd::sound;
  std::string cause;    ///< error message; empty if the run is sound
  base::Cause blamed{}; ///< cause of the error
  double reached = 0;   ///< simulated time reached [s]
  double wallSeconds = 0;
  MapFigures figures;
};

/// Folder and caches that trials use.
struct TrialPlace {
  std::filesystem::path folder; ///< folder for the vehicle file
  storage::BedCache* beds = nullptr;
  storage::SphereCache* spheres = nullptr;
  base::Exec exec = base::cpuExec(1);
};

/// Selects whether the step limit is checked before the run.
enum class StepCheck { asForUsers, none };

/// Text of the scene at this step [s]; 0: automatic step. Contains vehicle.spec only if the scene sets it.
std::string sceneText(const VehicleCase& what, double step);

/// The scene at this step. Writes the vehicle file to `folder`. Throws InputError if the scene is rejected.
scene::Scene sceneOf(const VehicleCase& what, double step, const std::filesystem::path& folder,
                     StepCheck check = StepCheck::asForUsers);

/// The longest step that the program allows [s]: contacts are stable, and oscillations and rotations are resolved.
double longestStep(const VehicleCase& what, const std::filesystem::path& folder);

/// Runs a case to the end of its window. Throws only if the program receives a stop signal.
VehicleTrial tryVehicle(const VehicleCase& what, double step, const TrialPlace& place,
                        StepCheck check = StepCheck::asForUsers);

} // namespace grouser::studies

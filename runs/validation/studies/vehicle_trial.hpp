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

/// One run of a vehicle for the stability maps, as a user would have it, and what it says in figures.
namespace grouser::studies {

/// A key of the vehicle file with another value: {"shoe", "mass", "0.85"}.
struct SpecChange {
  std::string section, key, value;
};

/// A scene of the shipped vehicle, or of one that it names itself.
struct VehicleCase {
  std::string scene;       ///< TOML but for run.time_step and vehicle.spec: ends with the section [vehicle]
  bool ownVehicle = false; ///< it has vehicle.spec, and `changes` none
  std::string run;         ///< more keys of [run]
  std::vector<SpecChange> changes;
  double from = 0, until = 0; ///< of the window whose means are compared [s]; the run ends with it
};

/// Means over the window but where it says otherwise. Figures of a run that was stopped are those until then.
struct MapFigures {
  double speed = NAN;            ///< of the hull along x [m/s]
  double height = NAN;           ///< of the hull's centre of mass [m]
  double lowest = NAN;           ///< that it was since the start [m]
  double pitch = NAN;            ///< nose up [rad]
  double power = NAN;            ///< of the drives [W]
  double tension = NAN;          ///< in the tracks' pins, over all steps [N]
  double sinkage = NAN;          ///< of the shoes that carry load [m]
  double dissipated = NAN;       ///< in the whole run [J]
  double integrationError = NAN; ///< of the whole run [J]
  double turnover = NAN;         ///< absolute work of the whole run [J]
  double leftOver = NAN;         ///< of the books of the whole run over the turnover [-]: rounding
  double speedMagnitude = NAN;   ///< mean of |speed|: more where it turns back within the window [m/s]
  double powerMagnitude = NAN;   ///< mean of the drives' |power|: more where they brake and drive in it [W]
  double blow = NAN;             ///< greatest of the whole run, as a run warns of [weights]
};

enum class TrialEnd { sound, stopped, refused };

struct VehicleTrial {
  double step = 0; ///< [s]
  TrialEnd end = TrialEnd::sound;
  std::string cause;    ///< error message; empty for sound runs
  base::Cause blamed{}; ///< cause of the error
  double reached = 0;   ///< [s]
  double wallSeconds = 0;
  MapFigures figures;
};

/// Where trials keep and write their files.
struct TrialPlace {
  std::filesystem::path folder; ///< of the vehicle file
  storage::BedCache* beds = nullptr;
  storage::SphereCache* spheres = nullptr;
  base::Exec exec = base::cpuExec(1);
};

/// Whether the steps are judged before the run, as for a user, or taken as they are.
enum class StepCheck { asForUsers, none };

/// The scene's file at this step [s]; 0: the automatic one. Without vehicle.spec where that is not its own.
std::string sceneText(const VehicleCase& what, double step);

/// The scene at this step. Writes its vehicle file into `folder`. Throws InputError where it is refused.
scene::Scene sceneOf(const VehicleCase& what, double step, const std::filesystem::path& folder,
                     StepCheck check = StepCheck::asForUsers);

/// The longest step that the program takes for it: stable contacts, and whatever swings or turns resolved [s].
double longestStep(const VehicleCase& what, const std::filesystem::path& folder);

/// Runs it to the end of its window. Throws nothing but what asks the program to stop.
VehicleTrial tryVehicle(const VehicleCase& what, double step, const TrialPlace& place,
                        StepCheck check = StepCheck::asForUsers);

} // namespace grouser::studies

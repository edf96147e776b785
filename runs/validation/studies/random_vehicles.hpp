// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/validation/studies/vehicle_verdict.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Random tracked vehicles: each run must be sound, rejected, or stopped with a cause.
namespace grouser::studies {

inline constexpr std::array<const char*, 3> kRandomBases{"light_tracked", "m113_like", "robot"};
inline constexpr std::array<const char*, 5> kRandomDrives{"straight", "turn", "pivot", "reversal", "torque"};

/// A random vehicle with its ground.
struct RandomVehicle {
  int number = 0;
  std::string base;  ///< vehicle file it is derived from
  std::string drive; ///< one of kRandomDrives
  bool onBed = false, rigidArms = false, bump = false;
  double stepShare = 0; ///< time step / longest step of the program [-]; 0: automatic step
  VehicleCase what;
};

/// Vehicle `number` of `seed`, derived from one of the ready files: up to two shoes fewer or four more with the idler
/// adjusted, a road wheel more or fewer, half to twice the mass of hull and shoes, centre of mass moved, a tenth to ten
/// times the tension, arms three times as soft or as stiff or rigid, other damping, stiffness, friction and tread. The
/// ground is rigid with slopes up to 0.3, with one track on a bump in 20 % of cases, or a bed of three layers. Gravity
/// is 0 to 3 g in 25 % of cases. Drives: straight, turn, pivot, reversal, torque, up to 10 rad/s of the light vehicle.
/// Time step: automatic in half of the cases, else up to 1.1 times the longest step of the program.
/// Throws base::InputError if the installation lacks the vehicle file.
RandomVehicle randomVehicle(std::uint64_t seed, int number);

/// Runs it; on rigid ground also at a quarter of its step, and if figures of both disagree at neighbouring steps and
/// their quarters. `trials`: one, or pairs.
struct RandomOutcome {
  std::vector<VehicleTrial> trials;
};
RandomOutcome tryRandomVehicle(const RandomVehicle& vehicle, const TrialPlace& place);

/// Verdict. On a bed, which differs at another step: sound if the energy balance closes and no guard stopped the run,
/// stopped if the cause of the message is known. On rigid ground as for the maps (jobs::judge()).
Judgement judgeRandom(const RandomVehicle& vehicle, const RandomOutcome& outcome);

struct RandomVehicles {
  int vehicles = 100;
  std::int64_t seed = 1;
  jobs::PieceOptions pieces;
  jobs::StudyPlace place;
};
/// `grouser study random-vehicles`. Throws base::SimulationError, after writing all files, if one is silently wrong or
/// stopped for a wrong cause.
void studyRandomVehicles(const RandomVehicles& command);

} // namespace grouser::studies

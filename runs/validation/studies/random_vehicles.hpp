// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/validation/studies/vehicle_verdict.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Random tracked vehicles: each run must be sound, be rejected, or stop with a correct cause.
namespace grouser::studies {

inline constexpr std::array<const char*, 3> kRandomBases{"light_tracked", "m113_like", "robot"};
inline constexpr std::array<const char*, 5> kRandomDrives{"straight", "turn", "pivot", "reversal", "torque"};

/// A random vehicle with its ground.
struct RandomVehicle {
  int number = 0;
  std::string base;  ///< vehicle file from which the vehicle is derived
  std::string drive; ///< one of kRandomDrives
  bool onBed = false, rigidArms = false, bump = false;
  double stepShare = 0; ///< time step / longest step that the program allows [-]; 0: automatic step
  VehicleCase what;
};

/// Vehicle `number` of `seed`, derived from one of the ready files. Changes: up to two shoes fewer or four more, with
/// the idler adjusted; one road wheel more or fewer; 0.5 to 2 times the mass of hull and shoes; another centre of mass;
/// 0.1 to 10 times the tension; arms up to three times softer or stiffer, or rigid; other damping, stiffness, friction
/// and tread. Ground: rigid with slopes up to 0.3 (one track on a bump in 20 % of cases), or a bed of three layers. In
/// 25 % of cases, gravity is 0 to 3 g. Drives: straight, turn, pivot, reversal, torque, at speeds up to 10 rad/s of the
/// light vehicle. Time step: automatic in half of the cases, else up to 1.1 times the longest step of the program.
/// Throws base::InputError if the installation lacks the vehicle file.
RandomVehicle randomVehicle(std::uint64_t seed, int number);

/// Runs the vehicle; on rigid ground also at a quarter of its step. If figures of these two runs disagree, also runs
/// neighbouring steps and their quarters. `trials`: one run, or pairs of runs.
struct RandomOutcome {
  std::vector<VehicleTrial> trials;
};
RandomOutcome tryRandomVehicle(const RandomVehicle& vehicle, const TrialPlace& place);

/// Verdict. On rigid ground as for the maps (judge()). On a bed, which another step would change: sound if the energy
/// balance closes and no guard stopped the run; stopped if the cause of the message is known.
Judgement judgeRandom(const RandomVehicle& vehicle, const RandomOutcome& outcome);

struct RandomVehicles {
  int vehicles = 100;
  std::int64_t seed = 1;
  jobs::PieceOptions pieces;
  jobs::StudyPlace place;
};
/// `grouser study random-vehicles`. After writing all files, throws base::SimulationError if a run is silently wrong
/// (wrong without an error message) or stopped with a wrong cause.
void studyRandomVehicles(const RandomVehicles& command);

} // namespace grouser::studies

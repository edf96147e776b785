// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/pieces.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/validation/studies/vehicle_verdict.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Random tracked vehicles, as a user could have written them: each is to end sound, to be refused, or to be stopped
/// with a cause.
namespace grouser::studies {

inline constexpr std::array<const char*, 3> kRandomBases{"light_tracked", "m113_like", "robot"};
inline constexpr std::array<const char*, 5> kRandomDrives{"straight", "turn", "pivot", "reversal", "torque"};

/// A vehicle drawn at random, on its ground.
struct RandomVehicle {
  int number = 0;
  std::string base;  ///< the vehicle file that it comes from
  std::string drive; ///< one of kRandomDrives
  bool onBed = false, rigidArms = false, bump = false;
  double stepShare = 0; ///< of the longest step that the program takes [-]; 0: the automatic one
  VehicleCase what;
};

/// Vehicle `number` of `seed`, from one of the ready files: up to two shoes less or four more with the idler where they
/// ask for it, a road wheel more or less, half to twice the mass of hull and shoes, its centre moved, a tenth to ten
/// times the tension, arms three times as soft or as stiff or rigid, other damping, stiffness, frictions and tread. It
/// stands on rigid ground that may lean by 0.3, one track on a bump in a fifth of cases, or on a bed of three layers; a
/// quarter of cases has 0 to 3 g. Straight on, turning, on the spot, reversed, or by torques, up to 10 rad/s of the
/// light vehicle. The step is the automatic one in half of cases, else up to 1.1 of the longest that is taken.
/// Throws base::InputError where the installation has no such vehicle file.
RandomVehicle randomVehicle(std::uint64_t seed, int number);

/// Runs it, on rigid ground at a quarter of its step too, and where figures of the two disagree at neighbouring steps
/// and their quarters. `trials`: one, or pairs.
struct RandomOutcome {
  std::vector<VehicleTrial> trials;
};
RandomOutcome tryRandomVehicle(const RandomVehicle& vehicle, const TrialPlace& place);

/// Of a bed, which is another at another step: sound where the books close and no guard has spoken, stopped where the
/// message has a cause that is known. On rigid ground as of the maps (jobs::judge()).
Judgement judgeRandom(const RandomVehicle& vehicle, const RandomOutcome& outcome);

struct RandomVehicles {
  int vehicles = 100;
  std::int64_t seed = 1;
  jobs::PieceOptions pieces;
  jobs::StudyPlace place;
};
/// `grouser study random-vehicles`. Throws base::SimulationError, after all is written, where one is silently wrong or
/// stopped for a wrong cause.
void studyRandomVehicles(const RandomVehicles& command);

} // namespace grouser::studies

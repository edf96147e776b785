// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "contact/contact_law.hpp"
#include "coupling/stage_timer.hpp"
#include "runs/scene/scene.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Benchmarks; their output names machine and commit.
namespace grouser::bench {

/// Times of several equal batches of steps [us per step].
struct BatchTimes {
  std::int64_t steps = 0; ///< steps per batch
  std::vector<double> microseconds;
  double median() const, least() const, most() const;
};

/// Standard bed of the benchmarks: a jittered cubic lattice of spacing 2.1 radii in five layers, in a square box with
/// walls, settled under gravity.
struct BedBench {
  std::int64_t grains = 285000;
  double radius = 0.027;    ///< [m]
  double jitter = 0.9;      ///< random displacement / gap of the lattice [-], 0 to 1
  double skin = 0.3;        ///< [radii]
  int lanes = 16;           ///< GrainModel::mostSimdLanes
  double friction = 0.5;    ///< [-]
  double restitution = 0.5; ///< [-]
  double stiffness = 1e6;   ///< [N/m]
  double density = 2500;    ///< [kg/m3]
  double radiiSpread = 0;   ///< radii uniform within +- this fraction of their mean, same mean volume [-]
  bool hertz = false;       ///< Hertz contacts with the stiffness `stiffness` at an overlap of 1e-3 radii
  double rolling = 0;       ///< rolling friction [-]
  bool fixedFloor = false;  ///< floor of fixed grains instead of a plane, not counted in `grains`
  bool periodic = false;    ///< periodic along x and y instead of walls
  double timeStep = 5e-5;   ///< [s]
  double settleTime = 0.5;  ///< [s]
  std::int64_t steps = 0;   ///< steps per batch; 0: about one second
  int batches = 5;
  bool ledger = false; ///< use energy accounting, as in a run
  bool hash = false;   ///< compute the final state hash
  std::string start{}; ///< file of initial grains; empty: lattice
  std::string save{};  ///< file for the final grains; empty: none
  base::PeerUse peerMemory = base::PeerUse::automatic;
};

struct BedFigures {
  BatchTimes times;
  contact::ContactLaw law;         ///< law of grain-grain contacts, for comparison with other programs
  double edge = 0;                 ///< edge of the box [m]
  double contactsPerGrain = 0;     ///< contacts (each pair once) and wall contacts per grain [-]
  double listLength = 0;           ///< mean number of listed neighbours per grain, each pair twice [-]
  std::string features;            ///< features as text
  double stepsBetweenRebuilds = 0; ///< [-]; infinite if there was none during the timing
  double rebuildMicroseconds = 0;  ///< median time of a rebuild [us]
  double bytesPerGrain = 0;        ///< device memory between rebuilds [B]
  double peakBytesPerGrain = 0;    ///< maximum during rebuilds [B]
  double reservedPerGrain = 0;     ///< reserved for rebuilds [B]
  double settleSeconds = 0;        ///< wall time of settling [s]
  double kineticPerGrain = 0;      ///< mean kinetic energy / (m g radius) [-]
  std::int64_t stepsTaken = 0;     ///< settling and all batches
  std::string stateHash;           ///< empty: not computed
  // On several ranks.
  std::array<int, 3> subdomains{1, 1, 1};
  std::string way;                    ///< communication method
  double ghostShare = 0;              ///< ghosts over grains [-]
  double bytesAStep = 0;              ///< per step sent by the busiest rank [B]
  double leastWait = 0, mostWait = 0; ///< fraction of MPI wait time, minimum and maximum over ranks [-]
};
/// Collective: all ranks share one bed.
BedFigures benchBed(const BedBench& bench, const base::Exec& exec, const base::Comm& comm = {});

/// Options of the step breakdown.
struct StepBenchOptions {
  std::int64_t steps = 1000; ///< steps per batch and of the instrumented pass
  int batches = 5;
  /// Simulated time before the timing [s], from the start of the run or, with `fromDrive`, of the drive. Empty: until
  /// the end of the drive ramp.
  std::optional<double> after;
  bool fromDrive = false;
};

/// `grouser bench bed` and `grouser bench step`: print the figures, and write them to `json` unless empty.
struct BenchCommand {
  BedBench bed;
  StepBenchOptions step;
  std::string scene;
  std::vector<std::string> overrides;
  std::string device; ///< auto | cpu | cuda; empty: auto, or as in the scene
  int threads = 0;    ///< 0: all, or as in the scene
  std::string json;
  const base::Ranks* ranks = nullptr; ///< ranks of the run
  base::Comm comm() const { return ranks ? ranks->comm() : base::Comm(); }
};
void benchBedCommand(const BenchCommand& command);
void benchStepCommand(const BenchCommand& command);

} // namespace grouser::bench

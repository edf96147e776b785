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

/// Benchmarks. Their output contains machine and commit.
namespace grouser::bench {

/// Times of several equal batches of steps [us per step].
struct BatchTimes {
  std::int64_t steps = 0; ///< steps per batch
  std::vector<double> microseconds;
  double median() const, least() const, most() const;
};

/// Standard bed of the benchmarks: five layers of a jittered cubic lattice with a spacing of 2.1 radii, settled under
/// gravity in a square box with walls.
struct BedBench {
  std::int64_t grains = 285000;
  double radius = 0.027;    ///< [m]
  double jitter = 0.9;      ///< maximum random displacement / half the gap between neighbours [-], 0 to 1
  double skin = 0.3;        ///< skin of the neighbour lists [radii]
  int lanes = 16;           ///< maximum number of SIMD lanes, as GrainModel::maxSimdLanes
  double friction = 0.5;    ///< [-]
  double restitution = 0.5; ///< [-]
  double stiffness = 1e6;   ///< [N/m]
  double density = 2500;    ///< [kg/m3]
  double radiiSpread = 0;   ///< half width of the uniform radius distribution / mean radius; same mean volume [-]
  bool hertz = false;       ///< Hertz contacts; at an overlap of 1e-3 radii, they have the stiffness `stiffness`
  double rolling = 0;       ///< rolling friction [-]
  bool fixedFloor = false;  ///< floor of fixed grains instead of a plane; `grains` does not include them
  bool periodic = false;    ///< periodic boundaries in x and y instead of walls
  double timeStep = 5e-5;   ///< [s]
  double settleTime = 0.5;  ///< simulated time of settling [s]
  std::int64_t steps = 0;   ///< steps per batch; 0: as many as take about one second
  int batches = 5;
  bool ledger = false; ///< use energy accounting, as in a run
  bool hash = false;   ///< compute the final state hash
  std::string start{}; ///< file of initial grains; empty: lattice
  std::string save{};  ///< file for the final grains; empty: no file
  base::PeerUse peerMemory = base::PeerUse::automatic;
};

struct BedFigures {
  BatchTimes times;
  contact::ContactLaw law;         ///< law of grain-grain contacts, for comparison with other programs
  double edge = 0;                 ///< edge of the box [m]
  double contactsPerGrain = 0;     ///< grain contacts (each pair counted once) and wall contacts per grain [-]
  double listLength = 0;           ///< mean number of listed neighbours per grain; each pair is listed twice [-]
  std::string features;            ///< active features as text
  double stepsBetweenRebuilds = 0; ///< [-]; infinite if there was no rebuild during the timing
  double rebuildMicroseconds = 0;  ///< median time of a rebuild [us]
  double bytesPerGrain = 0;        ///< device memory between rebuilds [B]
  double peakBytesPerGrain = 0;    ///< maximum device memory during rebuilds [B]
  double reservedPerGrain = 0;     ///< device memory reserved for rebuilds [B]
  double settleSeconds = 0;        ///< wall time of settling [s]
  double kineticPerGrain = 0;      ///< mean kinetic energy / (m g radius) [-]
  std::int64_t stepsTaken = 0;     ///< number of steps in settling and all batches
  std::string stateHash;           ///< empty: not computed
  // With several MPI ranks:
  std::array<int, 3> subdomains{1, 1, 1};
  std::string way;                 ///< communication method
  double ghostShare = 0;           ///< number of ghosts / number of grains [-]
  double bytesAStep = 0;           ///< maximum over the ranks of the data sent per step [B]
  double minWait = 0, maxWait = 0; ///< MPI wait time / wall time, minimum and maximum over the ranks [-]
};
/// Collective call: all ranks compute parts of the same bed.
BedFigures benchBed(const BedBench& bench, const base::Exec& exec, const base::Comm& comm = {});

/// Options of the step breakdown.
struct StepBenchOptions {
  std::int64_t steps = 1000; ///< number of steps in a batch, and in the instrumented pass
  int batches = 5;
  /// Simulated time before the timing [s], counted from the start of the run or, with `fromDrive`, from the start of
  /// the drive. Empty: the timing starts at the end of the drive ramp.
  std::optional<double> after;
  bool fromDrive = false;
};

/// `grouser bench bed` and `grouser bench step`: print the results, and write them to the file `json` unless it is
/// empty.
struct BenchCommand {
  BedBench bed;
  StepBenchOptions step;
  std::string scene;
  std::vector<std::string> overrides;
  std::string device; ///< auto | cpu | cuda; empty: auto for a bed, run.device for a scene
  int threads = 0;    ///< number of CPU threads; 0: all for a bed, run.threads for a scene
  std::string json;
  const base::Ranks* ranks = nullptr; ///< ranks of the run
  base::Comm comm() const { return ranks ? ranks->comm() : base::Comm(); }
};
void benchBedCommand(const BenchCommand& command);
void benchStepCommand(const BenchCommand& command);

} // namespace grouser::bench

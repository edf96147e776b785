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

/// Speed figures, with the machine and the commit that gave them.
namespace grouser::bench {

/// Times of several equal batches of steps [us a step].
struct BatchTimes {
  std::int64_t steps = 0; ///< of one batch
  std::vector<double> microseconds;
  double median() const, least() const, most() const;
};

/// The bed that all figures of speed are compared on: a jittered cubic lattice of spacing 2.1 radii in five layers,
/// in a square box with walls, settled under gravity.
struct BedBench {
  std::int64_t grains = 285000;
  double radius = 0.027;    ///< [m]
  double jitter = 0.9;      ///< of the lattice, as a share of its free gap [-], 0 to 1
  double skin = 0.3;        ///< [-] of the radius
  int lanes = 16;           ///< GrainModel::mostSimdLanes
  double friction = 0.5;    ///< [-]
  double restitution = 0.5; ///< [-]
  double stiffness = 1e6;   ///< [N/m]
  double density = 2500;    ///< [kg/m3]
  double radiiSpread = 0;   ///< radii are uniform within this share of their mean, of the same mean volume [-]
  bool hertz = false;       ///< Hertz' law, as stiff as `stiffness` at an overlap of 1e-3 radii
  double rolling = 0;       ///< rolling friction [-]
  bool fixedFloor = false;  ///< a layer of fixed grains in place of the plane below, not counted in `grains`
  bool periodic = false;    ///< along x and y, in place of walls
  double timeStep = 5e-5;   ///< [s]
  double settleTime = 0.5;  ///< [s]
  std::int64_t steps = 0;   ///< of one batch; 0: as many as take about a second
  int batches = 5;
  bool ledger = false; ///< keep the books of energies, as a run does
  bool hash = false;   ///< take the state hash at the end
  std::string start{}; ///< file of the grains that there are in place of the lattice; empty: that
  std::string save{};  ///< file that the grains are written to after the last batch; empty: none
  base::PeerUse peerMemory = base::PeerUse::automatic;
};

struct BedFigures {
  BatchTimes times;
  contact::ContactLaw law;         ///< of grains on each other, for whoever gives the same to another program
  double edge = 0;                 ///< of the box [m]
  double contactsPerGrain = 0;     ///< pairs in touch, each counted once, and contacts with walls, over grains [-]
  double listLength = 0;           ///< neighbours listed a grain, mean, each pair from both sides [-]
  std::string features;            ///< in words
  double stepsBetweenRebuilds = 0; ///< [-]; infinite where none was needed while timing
  double rebuildMicroseconds = 0;  ///< of one rebuild, median
  double bytesPerGrain = 0;        ///< on the device, between rebuilds [B]
  double peakBytesPerGrain = 0;    ///< the most while lists were made anew [B]
  double reservedPerGrain = 0;     ///< ... that the system has given for that [B]
  double settleSeconds = 0;        ///< wall time of settling [s]
  double kineticPerGrain = 0;      ///< over m g radius [-]
  std::int64_t stepsTaken = 0;     ///< settling and all batches
  std::string stateHash;           ///< empty where not taken
  // On several ranks.
  std::array<int, 3> subdomains{1, 1, 1};
  std::string way;                    ///< how elements travel
  double ghostShare = 0;              ///< ghosts over grains [-]
  double bytesAStep = 0;              ///< sent by the busiest rank while timing [B]
  double leastWait = 0, mostWait = 0; ///< share of the timed steps that a rank waited for others [-]
};
/// On several ranks all of them call it; they share one bed.
BedFigures benchBed(const BedBench& bench, const base::Exec& exec, const base::Comm& comm = {});

/// Where the time of a step goes.
struct StepBenchOptions {
  std::int64_t steps = 1000; ///< of one batch, and of the instrumented pass
  int batches = 5;
  /// Simulated time before anything is timed [s]: of the run, or where `fromDrive` after the vehicle drove off. Empty:
  /// until the drive is up to speed.
  std::optional<double> after;
  bool fromDrive = false;
};

/// `grouser bench bed` and `grouser bench step`: print the figures, and write them to `json` where it is not empty.
struct BenchCommand {
  BedBench bed;
  StepBenchOptions step;
  std::string scene;
  std::vector<std::string> overrides;
  std::string device; ///< auto | cpu | cuda; empty: auto, or as the scene says
  int threads = 0;    ///< 0: all, or as the scene says
  std::string json;
  const base::Ranks* ranks = nullptr; ///< that run it together
  base::Comm comm() const { return ranks ? ranks->comm() : base::Comm(); }
};
void benchBedCommand(const BenchCommand& command);
void benchStepCommand(const BenchCommand& command);

} // namespace grouser::bench

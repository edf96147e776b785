// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/exec.hpp"
#include "runs/scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

/// Checks before a run whether the machine has enough memory and disk space.
namespace grouser::forecast {

/// Memory and disk space that a run requires [bytes].
struct Demand {
  double process = 0;                          ///< total memory of the processes on this host
  double device = 0;                           ///< GPU memory of one rank; 0 on a CPU
  double frames = 0, checkpoint = 0, rows = 0; ///< disk space at the end; rows include tables and picture
  double grains = 0;                           ///< [-] number of grains
  double disk() const { return frames + checkpoint + rows; }
};

/// Available memory and disk space [bytes]; empty if unknown.
struct Room {
  std::optional<double> process, device, disk;
  std::filesystem::path place; ///< folder on the queried disk
};

/// Bytes per grain in frames.h5: position, velocity, speed, radius and id; optional contact force and fixed flag.
double frameBytesOfGrain(const scene::Scene& scene);
/// Bytes of the soil fields in a frame. Assumes a single cell if the scene defines neither a field box nor a bed.
double frameBytesOfFields(const scene::Scene& scene);

/// Demand of a run with `grains` grains and steps of `timeStep` [s] on `ranks` ranks, with `ranksOnHost` ranks on this
/// host. Uses round figures for vehicle, tables and program.
Demand demandOf(const scene::Scene& scene, std::int64_t grains, double timeStep, bool onDevice, int ranks = 1,
                int ranksOnHost = 1);

/// Available memory of the process (system, cgroup, `ulimit -v`) and of the device of `exec`, and free space on the
/// disk of `folder`. If `overwritten`, the files in the folder count as free space.
Room roomOf(const base::Exec& exec, const std::filesystem::path& folder, bool overwritten);

/// One line with the reason why the machine lacks memory or disk space, and the remedy; empty if the run fits.
std::string misfit(const Demand& demand, const Room& room);

/// Throws InputError "exceeds the resources of this machine: ..." if the run does not fit. `disk`: check disk space;
/// false for resumed runs, which already have most of their files. `ranks`: null for one rank.
void requireFit(const scene::Scene& scene, const base::Exec& exec, const std::filesystem::path& folder,
                bool overwritten, bool disk, const base::Ranks* ranks);

} // namespace grouser::forecast

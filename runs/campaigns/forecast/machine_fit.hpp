// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/exec.hpp"
#include "runs/scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

/// Whether a run fits its machine, asked before it begins.
namespace grouser::forecast {

/// What a run takes [bytes].
struct Demand {
  double process = 0;                          ///< memory of all its processes on this host together
  double device = 0;                           ///< of the GPU of one rank; 0 on a CPU
  double frames = 0, checkpoint = 0, rows = 0; ///< on the disk, at its end; tables and picture among the rows
  double grains = 0;                           ///< [-] that it is of
  double disk() const { return frames + checkpoint + rows; }
};

/// What there is of it [bytes]; empty where it cannot be known.
struct Room {
  std::optional<double> process, device, disk;
  std::filesystem::path place; ///< the folder that disk was asked of
};

/// Bytes of a grain in frames.h5: places, velocities, speeds and radii, ids, forces and marks where they are written.
double frameBytesOfGrain(const scene::Scene& scene);
/// Bytes of the fields of the soil in a frame. Counts one cell if the scene defines neither a field box nor a bed.
double frameBytesOfFields(const scene::Scene& scene);

/// Of a run with so many grains in steps of `timeStep` [s], shared by `ranks`, `ranksOnHost` of them on this host. What
/// a vehicle, tables and programs take beside their grains is a round figure.
Demand demandOf(const scene::Scene& scene, std::int64_t grains, double timeStep, bool onDevice, int ranks = 1,
                int ranksOnHost = 1);

/// Memory that a process may still take: what the system calls available, the limit of its group (cgroup) and that of
/// `ulimit -v`; of the device of `exec`; and of the disk that `folder` will lie on, where what stands in `folder` will
/// be overwritten if `overwritten`.
Room roomOf(const base::Exec& exec, const std::filesystem::path& folder, bool overwritten);

/// Why the run does not fit, with the remedy, in one line; empty where it does.
std::string misfit(const Demand& demand, const Room& room);

/// "does not fit this machine: ..." as an InputError where the run does not fit. `disk`: whether that counts: a run
/// that goes on has most of its files already. `ranks` may be null: one.
void requireFit(const scene::Scene& scene, const base::Exec& exec, const std::filesystem::path& folder,
                bool overwritten, bool disk, const base::Ranks* ranks);

} // namespace grouser::forecast

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/machine_fit.hpp"

#include "base/error.hpp"
#include "base/free_memory.hpp"
#include "runs/output/field_datasets.hpp"
#include "runs/output/grains_csv.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/field_checks.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/size_checks.hpp"
#include "terrain/grain_entry.hpp"
#include "terrain/grain_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grouser::forecast {

namespace fs = std::filesystem;

namespace {

constexpr double kGiB = 1073741824.0;
constexpr double kProgram = 100e6, kVehicle = 250e6; // process memory without grains [bytes]
constexpr double kRow = 1000, kVehicleRow = 7000;    // size of a row in results.h5 and timeseries.csv [bytes]
constexpr double kPicture = 1e6;                     // picture.png [bytes]
constexpr double kCheckpointBytes = 250;             // checkpoint size per grain with its contacts [bytes]
constexpr double kMaxRemembered = 2e6;               // maximum number of grains for which memory holds a second state

std::string size(double bytes) {
  return bytes >= 0.1 * kGiB ? fmt::format("{:.3g} GiB", bytes / kGiB) : fmt::format("{:.3g} MiB", bytes / 1048576.0);
}

/// Nearest existing folder at or above a path.
fs::path existing(fs::path folder) {
  std::error_code error;
  folder = fs::absolute(folder, error);
  while (!folder.empty() && !fs::exists(folder, error) && folder != folder.parent_path()) folder = folder.parent_path();
  return folder;
}

double bytesIn(const fs::path& folder) {
  std::error_code error;
  double bytes = 0;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (std::error_code of; at->is_regular_file(of)) bytes += static_cast<double>(at->file_size(of));
  return bytes;
}

} // namespace

double frameBytesOfGrain(const scene::Scene& scene) {
  const double words = 3 + 1 + 1 + 3 + 1 + (scene.output.contactForces ? 3 : 0); // place, radius, speed, velocity, id
  const bool fixed = scene.terrain && scene.terrain->granular() && scene.terrain->floorGrains;
  return 4 * (words + (fixed ? 1 : 0));
}

double frameBytesOfFields(const scene::Scene& scene) {
  const scene::Output& o = scene.output;
  base::Vec3d box{};
  if (!o.fieldsCell) return 0;
  if (o.fieldsLow)
    box = *o.fieldsHigh - *o.fieldsLow;
  else if (scene.terrain && scene.terrain->depth)
    box = {scene.terrain->size[0], scene.terrain->size[1], *scene.terrain->depth + *o.fieldsCell};
  double cells = 1;
  for (int a = 0; a < 3; ++a) cells *= std::max(1.0, std::floor(box[a] / *o.fieldsCell));
  return static_cast<double>(output::bytesOfFields(static_cast<std::size_t>(std::min(cells, setup::kMaxFieldCells))));
}

Demand demandOf(const scene::Scene& scene, std::int64_t grains, double timeStep, bool onDevice, int ranks,
                int ranksOnHost) {
  const auto all = static_cast<double>(grains);
  const double share = static_cast<double>(ranksOnHost) / ranks;
  Demand demand;
  demand.grains = all;
  const double lists = grains > 0 ? all * setup::grainMemory(scene).most() : 0;
  // Each rank stores the initial positions of all grains, and later its own state for a checkpoint.
  const double start = all * static_cast<double>(sizeof(terrain::GrainSpec) + sizeof(base::Position));
  const double saved = all * kCheckpointBytes * (all <= kMaxRemembered && ranks == 1 ? 2 : 1);
  demand.process =
      ranksOnHost * (kProgram + (scene.vehicle ? kVehicle : 0)) +
      std::max(ranksOnHost * start + (onDevice ? 0 : share * lists), share * saved + (onDevice ? 0 : share * lists));
  if (onDevice) demand.device = lists / ranks + kVehicle;

  const double steps = std::max(1.0, std::round(scene.run.duration / timeStep));
  const auto times = [&](double interval) { return std::floor(std::min(steps, scene.run.duration / interval)) + 1; };
  if (scene.output.frames)
    demand.frames = times(scene.run.frameInterval) * (all * frameBytesOfGrain(scene) + frameBytesOfFields(scene));
  demand.checkpoint = all * kCheckpointBytes;
  const double rows = times(scene.run.outputInterval);
  demand.rows = rows * (scene.vehicle ? kVehicleRow : kRow) + (scene.output.picture ? kPicture : 0);
  if (output::GrainsCsv::isRequested(scene.output.grainsCsv, grains, scene.run.duration, scene.run.outputInterval))
    demand.rows += rows * all * output::GrainsCsv::kLineBytes;
  return demand;
}

Room roomOf(const base::Exec& exec, const fs::path& folder, bool overwritten) {
  Room room;
  room.process = base::freeMemoryOfHost();
  if (!exec.onCpu()) room.device = base::freeMemoryOf(exec);
  room.place = existing(folder);
  std::error_code error;
  const fs::space_info disk = fs::space(room.place, error);
  if (!error && disk.capacity > 0)
    room.disk = static_cast<double>(disk.available) + (overwritten ? bytesIn(folder) : 0);
  return room;
}

std::string misfit(const Demand& demand, const Room& room) {
  std::vector<std::string> lacks;
  if (room.process && demand.process > *room.process)
    lacks.push_back(
        fmt::format("{} about {} of memory, but only {} are free: use fewer or larger grains or more hosts (mpirun), "
                    "or stop other programs",
                    demand.grains > 0 ? fmt::format("its {:.3g} grains require", demand.grains) : "it requires",
                    size(demand.process), size(*room.process)));
  if (room.device && demand.device > *room.device)
    lacks.push_back(fmt::format("its grains require about {} on each GPU, but only {} are free: use fewer or larger "
                                "grains, more GPUs (mpirun), or run.device = \"cpu\"",
                                size(demand.device), size(*room.device)));
  if (room.disk && demand.disk() > *room.disk)
    lacks.push_back(
        fmt::format("its results require about {} ({} of frames), but only {} are free in {}: raise "
                    "run.frame_interval, set output.frames = false, or choose a folder on another disk (--out)",
                    size(demand.disk()), size(demand.frames), size(*room.disk), room.place.string()));
  return fmt::format("{}", fmt::join(lacks, "; "));
}

void requireFit(const scene::Scene& scene, const base::Exec& exec, const fs::path& folder, bool overwritten, bool disk,
                const base::Ranks* ranks) {
  // The errors of these checks name the key.
  setup::checkFillSizes(scene);
  setup::checkBedSize(scene);
  const int all = ranks ? ranks->comm().size() : 1, here = ranks ? ranks->ranksOnHost() : 1;
  // Output intervals are rarely shorter than the step. The stability of the step is checked later.
  const double step = scene.run.timeStep.value_or(std::min(scene.run.outputInterval, scene.run.frameInterval));
  const Demand demand = demandOf(scene, setup::plannedGrains(scene), step, !exec.onCpu(), all, here);
  Room room = roomOf(exec, folder, overwritten);
  if (!disk) room.disk.reset();
  const std::string why = misfit(demand, room);
  if (!why.empty())
    throw base::InputError(fmt::format("{}: exceeds the resources of this machine: {}", scene.file.string(), why));
}

} // namespace grouser::forecast

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/output_times.hpp"

#include "runs/commands/recorder.hpp"
#include "runs/output/plots.hpp"
#include "runs/simulation/checkpoint.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/stopwatch.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace grouser::commands {

namespace fs = std::filesystem;
using support::Stopwatch;

namespace {

/// A folder of this probe alone, for as long as it lasts.
class Scratch {
public:
  explicit Scratch(fs::path folder) : folder_(std::move(folder)) {}
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  fs::path operator/(const char* name) const { return folder_ / name; }
  double bytesOf(const char* name) const {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(folder_ / name, error);
    return error ? 0.0 : static_cast<double>(bytes);
  }

private:
  fs::path folder_;
};

} // namespace

forecast::OutputTimes timeOutput(simulation::Simulation& simulation, const base::Exec& exec, const fs::path& folder,
                                 bool plots) {
  forecast::OutputTimes times;
  const Scratch files(folder);
  RunRequest request;
  request.folder = folder, request.force = true;
  {
    const Stopwatch begin;
    Recorder recorder(simulation, request, exec, nullptr, simulation.steps() + 100);
    times.begin = begin.seconds();
    constexpr int kRows = 3;
    recorder.row(), recorder.frame();
    const Stopwatch rows;
    for (int k = 0; k < kRows; ++k) recorder.row();
    times.row = rows.seconds() / kRows;
    if (simulation.setup().output.frames) {
      const double before = files.bytesOf("frames.h5");
      simulation.step();
      const Stopwatch frame;
      recorder.frame();
      times.frame = frame.seconds(), times.frameBytes = std::max(0.0, files.bytesOf("frames.h5") - before);
    }
    if (simulation.setup().output.picture) {
      const Stopwatch picture;
      recorder.picture(simulation.setup().output.pictureWidth);
      times.picture = picture.seconds();
    }
    const Stopwatch saving;
    simulation::Checkpoint checkpoint;
    const setup::Provenance& from = simulation.setup().provenance;
    checkpoint.scene = from.resolved, checkpoint.inputs = from.inputs;
    checkpoint.commit = support::buildInfo().commit, checkpoint.timeStep = simulation.timeStep();
    if (const auto& grains = simulation.ground().grains) checkpoint.lengths = simulation::lengthsOf(*grains);
    checkpoint.state = simulation.save();
    simulation::writeCheckpoint(files / simulation::kCheckpointName, checkpoint);
    times.checkpoint = saving.seconds(), times.checkpointBytes = files.bytesOf(simulation::kCheckpointName);
    recorder.writer().finish({});
  }
  if (!plots) return times;
  // Its file is closed by now, as where a run draws them.
  std::string warning;
  const Stopwatch one;
  if (!output::drawPlots(files / "results.h5", folder, {"ledger"}, warning).empty()) times.plot = one.seconds();
  return times;
}

} // namespace grouser::commands

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/output_times.hpp"

#include "runs/output/plots.hpp"
#include "runs/session/checkpoints.hpp"
#include "runs/session/recorder.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/support/stopwatch.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace grouser::session {

namespace fs = std::filesystem;
using support::Stopwatch;

namespace {

/// Temporary folder of the probe.
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

OutputTimes timeOutput(coupling::Simulation& simulation, const setup::RecordSetup& record, const base::Exec& exec,
                       const fs::path& folder, bool plots) {
  OutputTimes times;
  const Scratch files(folder);
  RunRequest request;
  request.folder = folder, request.force = true;
  {
    const Stopwatch begin;
    Recorder recorder(simulation, record, request, exec, nullptr, simulation.steps() + 100);
    times.begin = begin.seconds();
    constexpr int kRows = 3;
    recorder.row(), recorder.frame();
    const Stopwatch rows;
    for (int k = 0; k < kRows; ++k) recorder.row();
    times.row = rows.seconds() / kRows;
    if (record.output.frames) {
      const double before = files.bytesOf("frames.h5");
      simulation.step();
      const Stopwatch frame;
      recorder.frame();
      times.frame = frame.seconds(), times.frameBytes = std::max(0.0, files.bytesOf("frames.h5") - before);
    }
    if (record.output.picture) {
      const Stopwatch picture;
      recorder.picture(record.output.pictureWidth);
      times.picture = picture.seconds();
    }
    const Stopwatch saving;
    storage::writeCheckpoint(files / storage::kCheckpointName, checkpointOf(simulation, record.provenance));
    times.checkpoint = saving.seconds(), times.checkpointBytes = files.bytesOf(storage::kCheckpointName);
    recorder.writer().finish({});
  }
  if (!plots) return times;
  // The results file is closed here, as when a run draws plots.
  std::string warning;
  const Stopwatch one;
  if (!output::drawPlots(files / "results.h5", folder, {"ledger"}, warning).empty()) times.plot = one.seconds();
  return times;
}

} // namespace grouser::session

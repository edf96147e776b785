// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/output/grains_csv.hpp"
#include "runs/output/output.hpp"
#include "runs/session/drive_record.hpp"
#include "runs/session/row_columns.hpp"
#include "runs/session/run_request.hpp"
#include "runs/session/squeezed_record.hpp"
#include "runs/setup/record_setup.hpp"
#include "runs/storage/checkpoint.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::session {

/// Writer of channels, rows and frames of one simulation; one on each rank.
class Recorder {
public:
  /// `former`: checkpoint that the run resumes from, or null; `total`: last step of the run.
  /// `simulation` and `record` outlive it.
  Recorder(coupling::Simulation& simulation, const setup::RecordSetup& record, const RunRequest& options,
           const base::Exec& exec, const storage::Checkpoint* former, std::int64_t total);

  void row();
  void frame();
  /// Frame of a run that failed in the current step, unless this step has one. In scenes without bodies, grains may be
  /// some steps ahead of the step count.
  void lastFrame();
  /// Final surface of the ground, if a vehicle has changed it.
  void finalSurface();
  /// Draws picture.png of the current state.
  void picture(int width);

  output::RunWriter& writer() { return writer_; }
  const SqueezedRecord& squeezed() const { return squeezed_; } ///< record of all rows so far
  const DriveRecord& drive() const { return drive_; }          ///< record of all rows so far

private:
  void begin(const RunRequest& options, const storage::Checkpoint* former);
  output::Frame currentFrame() const;
  output::Frame frameWithFields();
  std::vector<coupling::Obstacle> drawnObstacles() const;

  coupling::Simulation& simulation_;
  const setup::RecordSetup& record_;
  const std::int64_t begunAt_; ///< first step: 0, or the step of the checkpoint
  RowColumns columns_;
  std::vector<output::FramePart> parts_;
  base::TriangleMesh ground_;
  output::RunWriter writer_;
  SqueezedRecord squeezed_;
  DriveRecord drive_;
  std::int64_t framedAt_ = -1; ///< step of the last frame, including frames of a resumed run
  std::optional<output::GrainsCsv> grainsCsv_;
  std::optional<terrain::FieldGrid> fieldGrid_; ///< grid of the fields in the frames; empty without fields
};

} // namespace grouser::session

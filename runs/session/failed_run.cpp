// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/failed_run.hpp"

#include "runs/output/manifest.hpp"
#include "runs/output/output.hpp"
#include "runs/output/plane_mesh.hpp"
#include "runs/output/plots.hpp"
#include "runs/output/sinkage.hpp"
#include "runs/render/image.hpp"
#include "runs/render/picture.hpp"
#include "runs/session/frame_of.hpp"
#include "runs/setup/record_setup.hpp"

#include <exception>

namespace grouser::session {

FailedBed::FailedBed(const coupling::GroundSetup& ground, const setup::RecordSetup& record, const RunRequest& options,
                     const base::Exec& exec)
    : options_(options), provenance_(record.provenance), output_(record.output),
      ground_(ground.rigid ? groundMesh(*ground.rigid) : output::planeMesh(record.planes)),
      device_(base::describe(exec)) {}

void FailedBed::leave(const terrain::Grains* bed, const std::string& message, base::Cause cause) {
  if (left_ || !options_.comm().first()) return;
  left_ = true;
  try {
    write(options_.comm().alone() ? bed : nullptr, message, cause);
  } catch (const std::exception&) {
    // For example a full disk.
  }
}

void FailedBed::write(const terrain::Grains* bed, const std::string& message, base::Cause cause) const {
  output::RunWriter::Options options;
  options.force = options_.force;
  options.frames = bed && output_.frames;
  options.metadata = {{"command_line", options_.commandLine},
                      {"device", device_},
                      {"phase", "settling"},
                      {"switches", options_.switches}};
  output::RunWriter writer(options_.folder, provenance_, {}, options);
  writer.abandon(message, cause); // first, in case the rest fails
  if (!bed) return;
  output::Frame frame;
  frame.step = bed->steps(), frame.time = static_cast<double>(bed->steps()) * bed->model().timeStep;
  addGrains(frame, *bed, false, false);
  writer.setParts({}, ground_);
  writer.frame(frame);
  if (output_.picture)
    render::writePng(render::drawFrame(frame, {}, {}, output_.pictureWidth), options_.folder / "picture.png");
  writer.abandon(message, cause); // again, with all files
}

void leavePlots(const std::filesystem::path& folder, bool ofVehicle) {
  try {
    const std::filesystem::path results = folder / "results.h5";
    if (ofVehicle) output::writeSinkageCsv(results, folder);
    std::string warning; // not printed after an error
    output::drawPlots(results, folder, output::kAllPlots, warning);
    output::listFiles(folder);
  } catch (const std::exception&) {
    // For example a run that ended before its first rows.
  }
}

} // namespace grouser::session

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/cause.hpp"
#include "base/comm.hpp"
#include "base/sphere_set.hpp"
#include "runs/output/option_names.hpp"
#include "runs/output/records.hpp"
#include "runs/output/result_fields.hpp"
#include "runs/output/soil_result.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/support/file_lock.hpp"
#include "terrain/bed_structure.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Results folder of a run: results.h5 and timeseries.csv (rows), frames.h5 and frames.xdmf (frames),
/// scene.toml (the resolved scene) and manifest.json. All functions accept plain data and do not depend on the
/// simulation.
namespace grouser::output {

/// Unless `force`, throws base::InputError with the remedy if `folder` exists and is not empty. Changes no files.
void checkOutputFolder(const std::filesystem::path& folder, bool force, const OptionNames& names = {});

/// Locks the folder to which a run writes, if the folder exists. Throws base::InputError if another run has locked
/// the folder.
void claimFolder(support::FileLock& lock, const std::filesystem::path& folder, const OptionNames& names = {});

/// Rows and frames that a resumed run keeps; later rows and frames are removed.
struct FormerOutput {
  std::vector<Row> rows;   ///< first rows of the new files
  std::int64_t frames = 0; ///< kept frames of frames.h5; 0: creates a new file
};

/// Writes the folder of a run. A killed run leaves readable files: each row and frame is flushed to the disk.
/// Each rank has a writer and makes the same calls; each rank passes its own grains to frame().
/// With `force`, the files of an earlier run are removed first; other files remain.
/// Calls that fail (disk full) throw support::NotWritten with the name of the file.
class RunWriter {
public:
  struct Options {
    OptionNames names;
    bool force = false;
    bool frames = true;                          ///< frames.h5 and frames.xdmf
    std::optional<FormerOutput> former;          ///< data of a stopped run that continues in its folder
    base::Comm comm;                             ///< the first rank writes rows, all ranks write frames
    std::map<std::string, std::string> metadata; ///< entries of manifest.json: command line, device, threads
  };
  RunWriter(std::filesystem::path folder, const setup::Provenance& provenance, std::vector<Channel> channels,
            Options options);
  ~RunWriter();
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;

  /// Stores a constant of the run in results.h5, e.g. kPitchRadius [m].
  void constant(const ResultConstant& constant, double value);

  /// Stores a fact of the run in manifest.json and as an attribute of results.h5.
  void fact(const std::string& key, const std::string& text);
  /// Stores the names of the parts as an attribute of results.h5; rows refer to parts by their index.
  void namesOfParts(const std::vector<std::string>& names);

  /// Stores the undisturbed surface, the reference of sinkage, in results.h5: terrain/surface/{x, y, height}.
  void surface(const UndisturbedSurface& surface);

  /// Stores the final heights of the bed at the nodes of surface() in results.h5: terrain/surface/final_height.
  void finalSurface(const std::vector<double>& height, std::size_t columns);

  /// Stores the final state of deformable soil in results.h5: terrain/soil/.
  void soil(const SoilResult& soil);

  /// Stores the structure of the bed in results.h5: terrain/bed/.
  void bed(const terrain::BedStructure& bed);

  /// Sets the parts and rigid ground of all frames; called once, before the first frame. The ground may be empty.
  void setParts(std::vector<FramePart> parts, const base::TriangleMesh& ground);

  /// Stores all inputs set so far, coupling::Input::kNumbers numbers each, in results.h5: inputs/series.
  void inputs(const std::vector<double>& all);

  void row(const Row& row);
  void frame(const Frame& frame);
  /// Closes the files and completes the manifest. Without this call, the manifest reports
  /// an unfinished run.
  void finish(const Summary& summary);
  /// Called instead of finish() after an error. Writes the error message to the manifest, if possible.
  void abandon(const std::string& reason, base::Cause cause = base::Cause::unknown);
  /// Called instead of finish() if the run was stopped and may be resumed.
  void stop(const std::string& reason);

  /// Rows kept from the stopped run; only on the first rank.
  std::vector<Row> formerRows() const;
  std::int64_t rows() const;   ///< number of rows so far, including kept rows
  std::int64_t frames() const; ///< number of frames so far, including kept frames
  /// Step of the last row kept from the stopped run; -1: no row. Only on the first rank.
  std::int64_t keptUpTo() const;
  /// Flushes the rows to the disk; required before a checkpoint that refers to them.
  void sync();

  const std::filesystem::path& folder() const;

private:
  struct Series;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::output

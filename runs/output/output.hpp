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
/// scene.toml (the resolved scene) and manifest.json. All functions take plain data and do not depend on the
/// simulation.
namespace grouser::output {

/// Throws base::InputError with the remedy if `folder` exists and is not empty, unless `force`. Changes no files.
void checkOutputFolder(const std::filesystem::path& folder, bool force, const OptionNames& names = {});

/// Locks the folder that a run writes to, if it exists. Throws base::InputError if another run has locked
/// the folder.
void claimFolder(support::FileLock& lock, const std::filesystem::path& folder, const OptionNames& names = {});

/// Rows and frames that a resumed run keeps; later ones are removed.
struct FormerOutput {
  std::vector<Row> rows;   ///< first rows of the new files
  std::int64_t frames = 0; ///< kept frames of frames.h5; 0: creates a new file
};

/// Writes a run's folder. A run that is killed leaves readable files: rows and frames are flushed as they come.
/// On several ranks each has a writer and makes the same calls; each passes its own grains to frame().
/// With `force` the files of a former run are removed first; other files stay.
/// Calls that fail (disk full) throw support::NotWritten with the file's name.
class RunWriter {
public:
  struct Options {
    OptionNames names;
    bool force = false;
    bool frames = true;                          ///< frames.h5 and frames.xdmf
    std::optional<FormerOutput> former;          ///< continue in the folder of a stopped run
    base::Comm comm;                             ///< one rank writes rows, all of them frames
    std::map<std::string, std::string> metadata; ///< entries of manifest.json: command line, device, threads
  };
  RunWriter(std::filesystem::path folder, const setup::Provenance& provenance, std::vector<Channel> channels,
            Options options);
  ~RunWriter();
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;

  /// A constant of the run in results.h5, e.g. kPitchRadius [m].
  void constant(const ResultConstant& constant, double value);

  /// Stores a fact of the run in manifest.json and as an attribute of results.h5.
  void fact(const std::string& key, const std::string& text);
  /// Names of the parts by the index that rows use, as an attribute of results.h5.
  void namesOfParts(const std::vector<std::string>& names);

  /// The undisturbed surface that sinkage is measured from, in results.h5: terrain/surface/{x, y, height}.
  void surface(const UndisturbedSurface& surface);

  /// Heights of the bed at the end, at the nodes of surface(); in results.h5: terrain/surface/final_height.
  void finalSurface(const std::vector<double>& height, std::size_t columns);

  /// Deformable soil at the end, in results.h5: terrain/soil/.
  void soil(const SoilResult& soil);

  /// Structure of the bed, in results.h5: terrain/bed/.
  void bed(const terrain::BedStructure& bed);

  /// Parts and rigid ground of the pictures; once, before the first frame. The ground mesh may be empty.
  void setParts(std::vector<FramePart> parts, const base::TriangleMesh& ground);

  /// All inputs set so far, coupling::Input::kNumbers a setting; in results.h5: inputs/series.
  void inputs(const std::vector<double>& all);

  void row(const Row& row);
  void frame(const Frame& frame);
  /// Closes the files and completes the manifest. Without this call the manifest
  /// reports an unfinished run.
  void finish(const Summary& summary);
  /// Instead of finish: an error stopped the run. Writes its message to the manifest, if possible.
  void abandon(const std::string& reason, base::Cause cause = base::Cause::unknown);
  /// Instead of finish: the run was stopped and may be resumed.
  void stop(const std::string& reason);

  /// Rows kept from a former run; on the first rank.
  std::vector<Row> formerRows() const;
  std::int64_t rows() const;   ///< number written so far, including former rows
  std::int64_t frames() const; ///< the same
  /// Step of the last row kept from a former run; -1: none. On the first rank.
  std::int64_t keptUpTo() const;
  /// Flushes the rows to the disk, before a checkpoint relies on them.
  void sync();

  const std::filesystem::path& folder() const;

private:
  struct Series;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace grouser::output

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/output.hpp"

#include "base/error.hpp"
#include "base/rounded.hpp"
#include "coupling/inputs.hpp"
#include "runs/output/frames_file.hpp"
#include "runs/output/manifest.hpp"
#include "runs/storage/checkpoint.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/folder_use.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/not_written.hpp"
#include "runs/support/output_place.hpp"
#include "runs/support/sealed_file.hpp"
#include "runs/support/shared_folder.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <fmt/os.h>

#include <fstream>
#include <optional>
#include <stdexcept>

namespace grouser::output {

namespace fs = std::filesystem;

namespace {

/// Number of rows by which a dataset grows: a compromise between long and short runs.
constexpr int kChunkRows = 64;

/// Overhead of HDF5 when a dataset grows by this number of rows: nodes of the chunk tree [bytes].
constexpr std::uint64_t kTreeBytes = 8192;

/// Files of a run; other files in the folder are not changed.
constexpr const char* kFiles[] = {"results.h5",
                                  "timeseries.csv",
                                  "frames.h5",
                                  "frames.xdmf",
                                  "scene.toml",
                                  "manifest.json",
                                  "sinkage.csv",
                                  "sinkage.png",
                                  "surface.png",
                                  "shoe_heights.png",
                                  "drive.png",
                                  "ledger.png",
                                  "mechanism.png",
                                  "picture.png",
                                  "grains.csv",
                                  "bed.png",
                                  storage::kCheckpointName};

bool isFilled(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder, error) && !fs::is_empty(folder, error);
}

void refuseFilled(const fs::path& folder, bool force, const OptionNames& names) {
  if (force || !isFilled(folder)) return;
  std::error_code error;
  throw base::InputError(fmt::format(
      "{}: the folder is not empty; choose another with {}, {}or overwrite it with {}", folder.string(), names.out,
      fs::exists(folder / storage::kCheckpointName, error) ? fmt::format("resume with {}, ", names.resume) : "",
      names.force));
}

fs::path prepared(fs::path folder, const RunWriter::Options& options, support::FileLock& lock) {
  if (options.former) return folder;
  checkOutputFolder(folder, options.force, options.names);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw base::InputError(fmt::format("{}: cannot create the folder ({}); choose another with {}", folder.string(),
                                       error.message(), options.names.out));
  claimFolder(lock, folder, options.names);
  refuseFilled(folder, options.force, options.names); // another run may have written to it since the first check
  for (const char* name : kFiles) fs::remove(folder / name, error);
  return folder;
}

/// Start of a column name for a path such as "vehicle/body/position".
std::string dotted(std::string path) {
  for (char& c : path)
    if (c == '/') c = '.';
  return path;
}

} // namespace

void checkOutputFolder(const fs::path& folder, bool force, const OptionNames& names) {
  support::requireFolder(folder);
  if (!force && isFilled(folder)) support::requireUnused(folder, names.out);
  refuseFilled(folder, force, names);
}

void claimFolder(support::FileLock& lock, const fs::path& folder, const OptionNames& names) {
  support::claimUnused(lock, folder, names.out);
}

/// Rows of a run in results.h5 and timeseries.csv, and the manifest; only the first rank writes them.
struct RunWriter::Series {
  support::FileLock lock; ///< lock on the folder of a new run; a resumed run already has one
  fs::path folder;
  const Options& options;
  std::vector<Channel> channels;
  support::Hdf5File results;
  std::vector<support::GrowingDataset> values;
  support::GrowingDataset steps, times;
  std::ofstream csv;
  Manifest manifest;
  std::size_t width = 0;
  std::int64_t rowsWritten = 0;
  std::optional<support::GrowingDataset> inputs; ///< created with the first input
  std::size_t inputsWritten = 0;                 ///< [numbers]

  /// Name of a new file while kept rows are copied into it, so that killing the run loses no rows.
  fs::path atFirst(const char* name) const { return folder / (std::string(name) + (options.former ? ".part" : "")); }

  Series(const fs::path& where, const setup::Provenance& provenance, std::vector<Channel> list, const Options& given)
      : folder(prepared(where, given, lock)), options(given), channels(std::move(list)),
        results(support::Hdf5File::create(atFirst("results.h5"))), csv(atFirst("timeseries.csv"), std::ios::binary),
        manifest(folder, provenance, options.metadata) {
    const std::string& resolved = provenance.resolved;
    support::replaceTextFile(folder / "scene.toml", resolved);
    const support::BuildInfo build = support::buildInfo();
    results.attribute("/", "creator", std::string("grouser"));
    results.attribute("/", "version", build.version);
    results.attribute("/", "commit", build.commit);
    results.attribute("/", "machine", support::machineText());
    results.attribute("/", "scene", resolved);
    makeSeries();
    writeHeader();
    if (options.former) takeOver();
    manifest.write(RunStatus::running);
  }

  void takeOver() {
    for (const Row& row : options.former->rows) append(row);
    flush();
    for (const char* name : {"results.h5", "timeseries.csv"}) fs::rename(atFirst(name), folder / name);
  }

  void append(const Row& row) {
    if (row.values.size() != width) throw std::logic_error("row length does not match its channels");
    if (rowsWritten++ % kChunkRows == 0)
      requireRoom(results, (channels.size() + 2) * kTreeBytes + (width + 2) * kChunkRows * sizeof(double));
    steps.append(&row.step);
    times.append(&row.time);
    const double* number = row.values.data();
    for (std::size_t c = 0; c < channels.size(); ++c) {
      values[c].append(number);
      number += channels[c].width;
    }
    writeCsvRow(row);
  }

  /// Layout of H5MD: each quantity is a group with step, time and value; step and time are links to shared datasets.
  void makeSeries() {
    steps = results.growing("/series/step", support::NumberType::Int64, 0, kChunkRows);
    times = results.growing("/series/time", support::NumberType::Float64, 0, kChunkRows);
    results.attribute("/series/time", "unit", std::string("s"));
    for (const Channel& c : channels) {
      const std::string group = "/" + c.path;
      values.push_back(
          results.growing(group + "/value", support::NumberType::Float64, c.width == 1 ? 0 : c.width, kChunkRows));
      results.link("/series/step", group + "/step");
      results.link("/series/time", group + "/time");
      results.attribute(group + "/value", "unit", c.unit);
      results.attribute(group + "/value", "help", c.help);
      if (!c.columns.empty()) results.attribute(group + "/value", "labels", c.columns);
      width += static_cast<std::size_t>(c.width);
    }
    results.flush();
  }

  /// Creates the data other than series.
  void array(const ResultConstant& what, const std::vector<double>& numbers, const std::vector<std::uint64_t>& shape) {
    results.write(std::string("/") + what.path, numbers, shape);
    describe(what);
  }

  void describe(const ResultConstant& what) {
    const std::string path = std::string("/") + what.path;
    results.attribute(path, "unit", std::string(what.unit));
    results.attribute(path, "help", std::string(what.help));
  }

  void writeHeader() {
    csv << "step,time [s]";
    for (const Channel& c : channels) {
      if (c.width == 1) csv << ',' << dotted(c.path) << " [" << c.unit << ']';
      for (const std::string& column : c.columns)
        csv << ',' << dotted(c.path) << '.' << column << " [" << c.unit << ']';
    }
    csv << '\n' << std::flush;
  }

  void writeCsvRow(const Row& row) {
    std::string line = fmt::format("{},{}", row.step, base::nearestDecimal(row.time));
    const double* number = row.values.data();
    for (const Channel& c : channels) {
      if (c.width == 1 || !c.columns.empty())
        for (int i = 0; i < c.width; ++i) line += fmt::format(",{}", number[i]);
      number += c.width;
    }
    csv << line << '\n';
  }

  void flush() {
    results.flush();
    csv.flush();
    if (!csv) throw support::notWritten(folder / "timeseries.csv");
  }
};

struct RunWriter::Impl {
  fs::path folder;
  Options options;
  std::unique_ptr<Series> series; ///< set on the first rank only
  std::optional<FramesFile> frames;
  std::int64_t rows = 0, framesAdded = 0;

  Impl(const fs::path& where, const setup::Provenance& provenance, std::vector<Channel> channels, Options given)
      : folder(where), options(std::move(given)) {
    if (options.comm.first()) series = std::make_unique<Series>(where, provenance, std::move(channels), options);
    options.comm.wait(); // now the folder exists
    if (!options.former) return;
    rows = static_cast<std::int64_t>(options.former->rows.size());
    if (options.frames) framesAdded = options.former->frames;
  }
};

RunWriter::RunWriter(fs::path folder, const setup::Provenance& provenance, std::vector<Channel> channels,
                     Options options) {
  for (const Channel& c : channels)
    if (!c.columns.empty() && c.columns.size() != static_cast<std::size_t>(c.width))
      throw std::logic_error("channel " + c.path + ": one column per number");
  const bool begun = !options.former && options.comm.first();
  std::error_code unknown;
  const bool there = fs::exists(folder, unknown);
  const auto takeBack = [&] {
    std::error_code error;
    for (const char* name : kFiles)
      if (begun) fs::remove(folder / name, error);
    if (begun && !there) fs::remove(folder, error);
  };
  try {
    impl_ = std::make_unique<Impl>(folder, provenance, std::move(channels), std::move(options));
  } catch (const base::InputError&) {
    throw; // no file has been changed yet
  } catch (...) {
    takeBack(); // the disk is full: remove the incomplete files
    throw;
  }
  if (const std::optional<int> rank = support::rankNotSeeing(folder, impl_->options.comm); rank && *rank > 0) {
    impl_.reset();
    takeBack();
    throw base::InputError(fmt::format("{}: rank {} cannot access this folder of rank 0; start all ranks in the same "
                                       "folder; on several hosts, set --out to a folder shared by all hosts",
                                       folder.string(), *rank));
  }
}

RunWriter::~RunWriter() = default;

const fs::path& RunWriter::folder() const { return impl_->folder; }

void RunWriter::constant(const ResultConstant& constant, double value) {
  if (impl_->series) impl_->series->array(constant, {value}, {1});
}

void RunWriter::fact(const std::string& key, const std::string& text) {
  if (!impl_->series) return;
  impl_->series->results.attribute("/", key, text);
  impl_->series->manifest.note(key, text);
}

void RunWriter::namesOfParts(const std::vector<std::string>& names) {
  if (impl_->series && !names.empty()) impl_->series->results.attribute("/", "parts", names);
}

std::vector<Row> RunWriter::formerRows() const {
  return impl_->options.former ? impl_->options.former->rows : std::vector<Row>{};
}

void RunWriter::surface(const UndisturbedSurface& surface) {
  if (!impl_->series) return;
  Series& series = *impl_->series;
  series.array(kSurfaceX, surface.x, {surface.x.size()});
  series.array(kSurfaceY, surface.y, {surface.y.size()});
  series.array(kSurfaceHeight, surface.height, {surface.y.size(), surface.x.size()});
  series.results.attribute(std::string("/") + kSurfaceHeight.path, "interpolation", surface.interpolation);
}

void RunWriter::finalSurface(const std::vector<double>& height, std::size_t columns) {
  if (!impl_->series) return;
  impl_->series->array(kSurfaceFinal, height, {height.size() / columns, columns});
}

void RunWriter::soil(const SoilResult& soil) {
  if (!impl_->series) return;
  Series& series = *impl_->series;
  for (const SoilConstantField& c : kSoilConstants) constant(c.constant, soil.constants.*c.member);
  if (soil.sinkage.empty()) return;
  requireRoom(series.results, std::size(kSoilMaps) * (kTreeBytes + soil.sinkage.size() * sizeof(float)));
  for (const SoilLine& l : kSoilLines)
    if (const std::vector<double>& numbers = soil.*l.member; !numbers.empty())
      series.array(l.line, numbers, {numbers.size()});
  for (const SoilMapField& map : kSoilMaps) {
    const std::string path = std::string("/") + map.field.path;
    series.results.write(path, soil.*map.member, {soil.rows, soil.columns}, true);
    series.describe(map.field);
  }
}

void RunWriter::bed(const terrain::BedStructure& bed) {
  if (!impl_->series) return;
  for (const BedConstant& c : kBedConstants) constant(c.constant, bed.*c.member);
  for (const BedCurve& c : kBedCurves) impl_->series->array(c.curve, bed.*c.member, {(bed.*c.member).size()});
}

void RunWriter::setParts(std::vector<FramePart> parts, const base::TriangleMesh& ground) {
  Impl& w = *impl_;
  if (!w.options.frames) return;
  if (w.framesAdded > 0) {
    w.frames.emplace(FramesFile::goOn(w.folder, std::move(parts), ground, w.framesAdded, w.options.comm));
  } else {
    w.frames.emplace(w.folder, std::move(parts), ground, w.options.comm);
  }
}

void RunWriter::inputs(const std::vector<double>& all) {
  if (!impl_->series || all.size() <= impl_->series->inputsWritten) return;
  Series& s = *impl_->series;
  constexpr int kWidth = coupling::Input::kNumbers;
  if (!s.inputs) {
    s.inputs = s.results.growing(kInputs.path, support::NumberType::Float64, kWidth, kChunkRows);
    s.results.attribute(kInputs.path, "unit", std::string(kInputs.unit));
    s.results.attribute(kInputs.path, "help", std::string(kInputs.help));
    s.results.attribute(kInputs.path, "kinds", base::wordsOf<coupling::InputKind>());
  }
  for (; s.inputsWritten < all.size(); s.inputsWritten += kWidth) s.inputs->append(all.data() + s.inputsWritten);
}

void RunWriter::row(const Row& row) {
  ++impl_->rows;
  if (!impl_->series) return;
  impl_->series->append(row);
  impl_->series->flush();
}

void RunWriter::frame(const Frame& frame) {
  Impl& w = *impl_;
  if (w.options.frames && !w.frames) setParts({}, {});
  if (!w.frames) return;
  w.frames->add(frame);
  ++w.framesAdded;
}

void RunWriter::finish(const Summary& summary) {
  Impl& w = *impl_;
  w.frames.reset();
  if (!w.series) return;
  requireRoom(w.series->results, kTreeBytes);
  w.series->results.attribute("/", "state_hash", summary.stateHash);
  w.series->results.flush();
  w.series->manifest.add(summary);
  if (!summary.incomplete.empty()) w.series->manifest.note("incomplete", summary.incomplete);
  w.series->manifest.write(summary.incomplete.empty() ? RunStatus::finished : RunStatus::incomplete);
}

void RunWriter::abandon(const std::string& reason, base::Cause cause) {
  if (!impl_->series) return;
  impl_->series->manifest.note("error", reason);
  if (cause != base::Cause::unknown) impl_->series->manifest.note("cause", std::string(base::wordOf(cause)));
  try {
    impl_->series->manifest.write(RunStatus::failed);
  } catch (const std::exception&) {
    // The disk may be full. The user needs the error that ended the run, not this one.
  }
}

void RunWriter::stop(const std::string& reason) {
  if (!impl_->series) return;
  impl_->series->manifest.note("stopped", reason);
  impl_->series->manifest.write(RunStatus::stopped);
}

std::int64_t RunWriter::rows() const { return impl_->rows; }

std::int64_t RunWriter::keptUpTo() const {
  const auto& former = impl_->options.former;
  return former && !former->rows.empty() ? former->rows.back().step : -1;
}

std::int64_t RunWriter::frames() const { return impl_->framesAdded; }

void RunWriter::sync() {
  if (!impl_->series) return;
  impl_->series->flush();
  for (const char* name : {"results.h5", "timeseries.csv"}) support::syncFile(impl_->folder / name);
}

} // namespace grouser::output

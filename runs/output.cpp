// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output.hpp"

#include "base/error.hpp"
#include "runs/build_info.hpp"
#include "runs/frames_file.hpp"
#include "runs/hdf5_file.hpp"
#include "runs/manifest.hpp"

#include <fmt/format.h>
#include <fmt/os.h>

#include <fstream>
#include <optional>
#include <stdexcept>

namespace grouser::runs {

namespace fs = std::filesystem;

namespace {

/// Rows of a channel that are allotted at a time: enough that a long run does not scatter, small enough for short ones.
constexpr int kChunkRows = 64;

/// The files of a run; what else lies in its folder is not ours.
constexpr const char* kFiles[] = {"results.h5",       "timeseries.csv", "frames.h5",   "frames.xdmf",
                                  "scene.toml",       "manifest.json",  "sinkage.csv", "sinkage.png",
                                  "shoe_heights.png", "drive.png",      "ledger.png",  "picture.png"};

void writeText(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(fmt::format("{}: could not be written; is the disk full?", path.string()));
}

fs::path prepared(fs::path folder, bool force) {
  checkOutputFolder(folder, force);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw base::InputError(
        fmt::format("{}: the folder cannot be made ({}); name another with --out", folder.string(), error.message()));
  for (const char* name : kFiles) fs::remove(folder / name, error);
  return folder;
}

/// "vehicle/body/position" as the start of a column's name.
std::string dotted(std::string path) {
  for (char& c : path)
    if (c == '/') c = '.';
  return path;
}

} // namespace

void checkOutputFolder(const fs::path& folder, bool force) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error))
    throw base::InputError(
        fmt::format("{}: is a file, where the results' folder should be; name another with --out", folder.string()));
  if (!force && !fs::is_empty(folder, error))
    throw base::InputError(fmt::format(
        "{}: the folder is not empty; name another with --out, or overwrite it with --force", folder.string()));
}

struct RunWriter::Impl {
  fs::path folder;
  Options options;
  std::vector<Channel> channels;
  Hdf5File results;
  std::vector<GrowingDataset> values;
  GrowingDataset steps, times;
  std::ofstream csv;
  std::optional<FramesFile> frames;
  Manifest manifest;
  std::size_t width = 0;

  Impl(const fs::path& where, const Scene& scene, std::vector<Channel> list, Options given)
      : folder(prepared(where, given.force)), options(std::move(given)), channels(std::move(list)),
        results(Hdf5File::create(folder / "results.h5")), csv(folder / "timeseries.csv", std::ios::binary),
        manifest(folder, scene, options.metadata) {
    const std::string resolved = resolvedToml(scene);
    writeText(folder / "scene.toml", resolved);
    const BuildInfo build = buildInfo();
    results.attribute("/", "creator", std::string("grouser"));
    results.attribute("/", "version", build.version);
    results.attribute("/", "commit", build.commit);
    results.attribute("/", "machine", machineText());
    results.attribute("/", "scene", resolved);
    makeSeries();
    writeHeader();
    manifest.write("running");
  }

  /// H5MD's layout: each quantity is a group of step, time and value; step and time are one dataset under many names.
  void makeSeries() {
    steps = results.growing("/series/step", NumberType::Int64, 0, kChunkRows);
    times = results.growing("/series/time", NumberType::Float64, 0, kChunkRows);
    results.attribute("/series/time", "unit", std::string("s"));
    for (const Channel& c : channels) {
      const std::string group = "/" + c.path;
      values.push_back(results.growing(group + "/value", NumberType::Float64, c.width == 1 ? 0 : c.width, kChunkRows));
      results.link("/series/step", group + "/step");
      results.link("/series/time", group + "/time");
      results.attribute(group + "/value", "unit", c.unit);
      results.attribute(group + "/value", "help", c.help);
      if (!c.columns.empty()) results.attribute(group + "/value", "labels", c.columns);
      width += static_cast<std::size_t>(c.width);
    }
    results.flush();
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
    std::string line = fmt::format("{},{}", row.step, row.time);
    const double* number = row.values.data();
    for (const Channel& c : channels) {
      if (c.width == 1 || !c.columns.empty())
        for (int i = 0; i < c.width; ++i) line += fmt::format(",{}", number[i]);
      number += c.width;
    }
    csv << line << '\n' << std::flush;
    if (!csv)
      throw std::runtime_error(
          fmt::format("{}: could not be written; is the disk full?", (folder / "timeseries.csv").string()));
  }
};

RunWriter::RunWriter(fs::path folder, const Scene& scene, std::vector<Channel> channels, Options options) {
  for (const Channel& c : channels)
    if (!c.columns.empty() && c.columns.size() != static_cast<std::size_t>(c.width))
      throw std::logic_error("channel " + c.path + ": as many columns as numbers");
  impl_ = std::make_unique<Impl>(folder, scene, std::move(channels), std::move(options));
}

RunWriter::~RunWriter() = default;

const fs::path& RunWriter::folder() const { return impl_->folder; }

void RunWriter::labels(const std::string& path, const std::vector<std::string>& names) {
  impl_->results.attribute("/" + path + "/value", "labels", names);
}

void RunWriter::constant(const std::string& path, const std::string& unit, double value) {
  impl_->results.write("/" + path, std::vector<double>{value}, {1});
  impl_->results.attribute("/" + path, "unit", unit);
}

void RunWriter::setParts(std::vector<FramePart> parts, base::TriangleMesh ground) {
  if (impl_->options.frames) impl_->frames.emplace(impl_->folder, std::move(parts), ground);
}

void RunWriter::row(const Row& row) {
  Impl& w = *impl_;
  if (row.values.size() != w.width) throw std::logic_error("a row has another length than its channels");
  w.steps.append(&row.step);
  w.times.append(&row.time);
  const double* number = row.values.data();
  for (std::size_t c = 0; c < w.channels.size(); ++c) {
    w.values[c].append(number);
    number += w.channels[c].width;
  }
  w.results.flush();
  w.writeCsvRow(row);
}

void RunWriter::frame(const Frame& frame) {
  Impl& w = *impl_;
  if (w.options.frames && !w.frames) setParts({}, {});
  if (w.frames) w.frames->add(frame);
}

void RunWriter::finish(const Summary& summary) {
  Impl& w = *impl_;
  w.results.attribute("/", "state_hash", summary.stateHash);
  w.results.flush();
  w.frames.reset();
  w.manifest.add(summary);
  w.manifest.write("finished");
}

void RunWriter::abandon(const std::string& reason) {
  impl_->manifest.note("error", reason);
  impl_->manifest.write("failed");
}

} // namespace grouser::runs

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/frames_reader.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "runs/output/flat.hpp"
#include "runs/output/fluid_datasets.hpp"
#include "runs/output/soil_datasets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::output {

namespace {

std::string groupOf(std::size_t frame) { return fmt::format("/{:06}", frame); }

/// Opens the file. Errors state the remedy.
support::Hdf5File opened(const std::filesystem::path& path) {
  base::requireInput(path, "specify the frames.h5 of a run");
  try {
    return support::Hdf5File::open(path);
  } catch (const base::InputError&) {
    throw base::InputError(fmt::format(
        "{}: is not an HDF5 file, is truncated, or is still being written; specify the frames.h5 of a finished run",
        path.string()));
  }
}

} // namespace

FramesReader::FramesReader(const std::filesystem::path& path) : file_(opened(path)) {
  while (file_.has(groupOf(times_.size()))) {
    const double time = file_.number(groupOf(times_.size()), "time");
    if (!std::isfinite(time)) damaged(fmt::format("frame {} has no time", times_.size()));
    times_.push_back(time);
  }
  if (times_.empty())
    throw base::InputError(
        fmt::format("{}: contains no frames; specify the frames.h5 of a run with output.frames = true", path.string()));
  readParts();
  readGround();
}

bool FramesReader::hasVehicle() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const StoredPart& p) { return p.kind == PartKind::chassis; });
}

void FramesReader::damaged(const std::string& what) const {
  throw base::InputError(
      fmt::format("{}: {}; the file is damaged or was written by another program; run the scene again, or restore the "
                  "file from a copy",
                  path().string(), what));
}

std::vector<base::Vec3f> FramesReader::points(const std::string& dataset) const {
  const std::vector<std::uint64_t> shape = file_.shape(dataset);
  if (shape.size() != 2 || shape[1] != 3) damaged(dataset + " is not of shape [n, 3]");
  const std::vector<float> numbers = file_.read<float>(dataset);
  std::vector<base::Vec3f> points(shape[0]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    if (!isLength(points[i].x) || !isLength(points[i].y) || !isLength(points[i].z))
      damaged(fmt::format("row {} of {} is not finite, or above 1e7 m", i, dataset));
  }
  return points;
}

std::vector<float> FramesReader::perGrain(const std::string& dataset, std::size_t count) const {
  if (file_.shape(dataset) != std::vector<std::uint64_t>{count})
    damaged(fmt::format("{} must have one number for each of the {} grains", dataset, count));
  std::vector<float> numbers = file_.read<float>(dataset);
  for (const float x : numbers)
    if (!std::isfinite(x) || x < 0) damaged(fmt::format("{} has a number that is negative or not finite", dataset));
  return numbers;
}

std::vector<std::uint32_t> FramesReader::triangles(const std::string& dataset, std::uint64_t vertices) const {
  const std::vector<std::uint64_t> shape = file_.shape(dataset);
  if (shape.size() != 2 || shape[1] != 3) damaged(dataset + " is not of shape [n, 3]");
  std::vector<std::uint32_t> corners = file_.read<std::uint32_t>(dataset);
  for (const std::uint32_t v : corners)
    if (v >= vertices)
      damaged(fmt::format("{} has the vertex index {}, but there are {} vertices", dataset, v, vertices));
  return corners;
}

void FramesReader::readParts() {
  if (!file_.has("/parts/triangles")) return;
  const std::string position = groupOf(std::size_t{0}) + "/parts/position";
  if (!file_.has(position)) damaged(position + " is missing");
  const auto corners = triangles("/parts/triangles", points(position).size());
  const auto partOf = file_.read<std::uint32_t>("/parts/part"), kindOf = file_.read<std::uint32_t>("/parts/kind");
  const std::vector<std::string> names = file_.texts("/parts/part", "names"),
                                 kinds = file_.texts("/parts/kind", "names");
  if (corners.size() != 3 * partOf.size() || kindOf.size() != partOf.size()) damaged("/parts/triangles has no parts");
  parts_.resize(names.size());
  for (std::size_t t = 0; t < partOf.size(); ++t) {
    if (partOf[t] >= names.size() || kindOf[t] >= kinds.size())
      damaged("a triangle of /parts has an invalid part index");
    StoredPart& part = parts_[partOf[t]];
    part.name = names[partOf[t]], part.kind = base::valueOf<PartKind>(kinds[kindOf[t]]).value_or(PartKind::other);
    part.triangles.insert(part.triangles.end(), &corners[3 * t], &corners[3 * t] + 3);
  }
  for (StoredPart& part : parts_) {
    if (part.triangles.empty()) continue;
    const auto [low, high] = std::minmax_element(part.triangles.begin(), part.triangles.end());
    part.first = *low, part.count = *high - *low + 1;
    for (std::uint32_t& v : part.triangles) v -= part.first;
  }
}

void FramesReader::readGround() {
  if (!file_.has("/ground/triangles")) return;
  for (const base::Vec3f& p : points("/ground/position")) ground_.vertices.push_back(p.as<double>());
  ground_.indices = triangles("/ground/triangles", ground_.vertices.size());
}

StoredFrame FramesReader::read(std::size_t frame) const {
  const std::string group = groupOf(frame);
  StoredFrame f;
  f.time = times_[frame];
  if (const std::string at = group + "/grains"; file_.has(at + "/position")) {
    f.positions = points(at + "/position");
    f.radii = perGrain(at + "/radius", f.positions.size());
    for (const float radius : f.radii)
      if (!isLength(radius) || radius == 0) damaged(at + "/radius has a radius outside (0, 1e7] m");
    f.speeds = perGrain(at + "/speed", f.positions.size());
  }
  if (f.positions.empty())
    if (const auto fluid = readFluid(file_, group)) f.fluid = true, drawFluid(*fluid, f.positions, f.radii, f.speeds);
  if (!parts_.empty()) {
    f.partVertices = points(group + "/parts/position");
    for (const StoredPart& part : parts_)
      if (part.first + std::size_t{part.count} > f.partVertices.size())
        damaged(fmt::format("frame {} lacks vertices of {}", frame, part.name));
  }
  f.soil = readSoil(file_, group);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const std::string places = group + "/partition/" + "xyz"[axis]; file_.has(places)) {
      f.borders[axis] = file_.read<double>(places);
      for (const double place : f.borders[axis])
        if (!std::isfinite(place)) damaged(places + " is not finite");
      if (!std::is_sorted(f.borders[axis].begin(), f.borders[axis].end())) damaged(places + " is not ascending");
    }
  return f;
}

} // namespace grouser::output

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"
#include "runs/support/hdf5_file.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace grouser::output {

/// A part of frames.h5: its triangles name vertices first ... first + count - 1 of each frame's part vertices.
struct StoredPart {
  std::string name;
  PartKind kind{};
  std::uint32_t first = 0, count = 0;
  std::vector<std::uint32_t> triangles; ///< 3 a triangle, counted from `first`
};

/// One frame as it is in the file. All arrays of grains have the same length.
struct StoredFrame {
  double time{};                              ///< [s]
  std::vector<base::Vec3f> positions;         ///< [m]
  std::vector<float> radii;                   ///< [m]
  std::vector<float> speeds;                  ///< [m/s]
  bool fluid = false;                         ///< the positions are particles of a fluid, not grains
  std::vector<base::Vec3f> partVertices;      ///< [m], world
  std::shared_ptr<const SoilSurface> soil;    ///< deformable ground; may be null
  std::array<std::vector<double>, 3> borders; ///< as in Frame
};

/// Reads the frames.h5 that a run has left (frames_file.hpp says what is in it). Every call throws base::InputError for
/// a damaged file.
class FramesReader {
public:
  explicit FramesReader(const std::filesystem::path& file);

  const std::filesystem::path& path() const { return file_.path(); }
  std::size_t count() const { return times_.size(); }
  double time(std::size_t frame) const { return times_[frame]; } ///< [s]
  const std::vector<StoredPart>& parts() const { return parts_; }
  bool hasVehicle() const; ///< a part that is a hull
  /// Rigid ground, or the floor beneath the grains; may be empty.
  const base::TriangleMesh& ground() const { return ground_; }
  StoredFrame read(std::size_t frame) const;

private:
  [[noreturn]] void damaged(const std::string& what) const;
  std::vector<base::Vec3f> points(const std::string& dataset) const;
  /// Numbers of a dataset, which must be `count`.
  std::vector<float> perGrain(const std::string& dataset, std::size_t count) const;
  void readParts();
  void readGround();

  support::Hdf5File file_;
  std::vector<double> times_;
  std::vector<StoredPart> parts_;
  base::TriangleMesh ground_;
};

} // namespace grouser::output

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

/// A part in frames.h5; its triangles use the vertices first ... first + count - 1 of the part vertices of each frame.
struct StoredPart {
  std::string name;
  PartKind kind{};
  std::uint32_t first = 0, count = 0;
  std::vector<std::uint32_t> triangles; ///< 3 per triangle, counted from `first`
};

/// One frame in the file. All arrays of grains have the same length.
struct StoredFrame {
  double time{};                              ///< [s]
  std::vector<base::Vec3f> positions;         ///< [m]
  std::vector<float> radii;                   ///< [m]
  std::vector<float> speeds;                  ///< [m/s]
  bool fluid = false;                         ///< whether the positions are those of fluid particles, not grains
  std::vector<base::Vec3f> partVertices;      ///< in the world frame [m]
  std::shared_ptr<const SoilSurface> soil;    ///< surface of deformable soil; may be null
  std::array<std::vector<double>, 3> borders; ///< as in Frame
};

/// Reads frames.h5 of a run (format: frames_file.hpp). All functions throw base::InputError if the file is damaged.
class FramesReader {
public:
  explicit FramesReader(const std::filesystem::path& file);

  const std::filesystem::path& path() const { return file_.path(); }
  std::size_t count() const { return times_.size(); }
  double time(std::size_t frame) const { return times_[frame]; } ///< [s]
  const std::vector<StoredPart>& parts() const { return parts_; }
  bool hasVehicle() const; ///< whether a part is a hull
  /// Rigid ground, or the floor below the grains; may be empty.
  const base::TriangleMesh& ground() const { return ground_; }
  StoredFrame read(std::size_t frame) const;

private:
  [[noreturn]] void damaged(const std::string& what) const;
  std::vector<base::Vec3f> points(const std::string& dataset) const;
  /// Numbers of a dataset; throws if there are not exactly `count`, or if one is negative or not finite.
  std::vector<float> perGrain(const std::string& dataset, std::size_t count) const;
  /// Vertex indices [triangles, 3], all less than `vertices`.
  std::vector<std::uint32_t> triangles(const std::string& dataset, std::uint64_t vertices) const;
  void readParts();
  void readGround();

  support::Hdf5File file_;
  std::vector<double> times_;
  std::vector<StoredPart> parts_;
  base::TriangleMesh ground_;
};

} // namespace grouser::output

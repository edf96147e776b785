// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/output/records.hpp"
#include "runs/support/file_field.hpp"
#include "runs/support/hdf5_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace grouser::output {

/// Grains, parts and ground over time for ParaView: frames.h5 contains the numbers, frames.xdmf describes them.
///
/// frames.h5:  /parts/triangles [t, 3], /parts/part [t], /parts/kind [t];  /ground/position [v, 3], /ground/triangles;
///             /vertices/1000 [1000, 1]: 0, 1, 2... for frames of 1000 grains;
///             /000012/grains/{position [n, 3], radius, speed, id}, /000012/parts/position [v, 3],
///             /000012/fields/{stress [z, y, x, 6], ...}: if the scene requests fields of the soil,
///             /000012/soil/{position [v, 3], triangles [t, 3], sinkage [v], ...}: deformable ground,
///             /000012/partition/{x, y, z} [b]: positions of subdomain borders along this axis [m], if there are any
/// frames.xdmf: a temporal collection of spatial collections "grains", "parts", "ground", "fields". It is replaced
/// atomically after each frame, so that it lists complete frames only.
class FramesFile {
public:
  /// With several ranks, all ranks make the same calls, each with its own grains.
  FramesFile(const std::filesystem::path& folder, std::vector<FramePart> parts, const base::TriangleMesh& ground,
             const base::Comm& comm = {});
  /// Continues the files of a stopped run with the same parts and ground; keeps only the first `kept` frames.
  static FramesFile goOn(const std::filesystem::path& folder, std::vector<FramePart> parts,
                         const base::TriangleMesh& ground, std::int64_t kept, const base::Comm& comm = {});
  /// Number of frames in the folder up to and including `lastStep`, at most `most`; reads all their data, and the
  /// names in later frames, which goOn() removes. Throws base::InputError if the file is missing or damaged.
  static std::int64_t framesUpTo(const std::filesystem::path& folder, std::int64_t lastStep, std::int64_t most);

  /// Throws std::logic_error if the arrays differ in length.
  void add(const Frame& frame);

private:
  FramesFile(const std::filesystem::path& folder, std::optional<support::Hdf5File> file, std::vector<FramePart> parts,
             const base::TriangleMesh& ground, const base::Comm& comm);
  std::uint64_t bytesOf(const Frame& frame, std::uint64_t grains) const;
  void writeAllButGrains(const Frame& frame, const std::string& group, std::uint64_t grains);
  void writeGrains(support::Hdf5File& file, const Frame& frame, const std::string& group) const;
  std::string listVertices(std::size_t grains);
  std::string pointsTopology(std::size_t points);
  /// Adds the XML of the next frame, which is already in frames.h5.
  void describe(std::size_t grains, std::int64_t step, double time);
  void writeXdmf() const;

  std::filesystem::path folder_;
  base::Comm comm_;
  std::optional<support::Hdf5File> file_; ///< open on the first rank only
  std::vector<FramePart> parts_;
  std::size_t partVertices_ = 0, partTriangles_ = 0, groundVertices_ = 0, groundTriangles_ = 0;
  std::string steps_; ///< XML of all frames so far
  std::int64_t count_ = 0;
};

/// Descriptions of all fields of frames.h5.
std::vector<support::FileField> frameFields();

} // namespace grouser::output

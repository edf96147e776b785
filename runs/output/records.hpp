// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/sphere_set.hpp"
#include "base/vec.hpp"
#include "runs/output/part_kind.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace grouser::terrain {
struct SoilFields;
}

/// Output of a run as plain data: rows of the time series, frames, and the summary.
namespace grouser::output {

/// Surface of the ground before contact with the vehicle, on a grid of nodes.
struct UndisturbedSurface {
  std::vector<double> x, y;   ///< node coordinates [m]
  std::vector<double> height; ///< heights [y, x], row by row [m]
  std::string interpolation;  ///< interpolation between nodes: "bilinear", "Catmull-Rom" or "monotone"
};

/// One quantity of the time series. `path`: group in results.h5 and, with dots instead of slashes, column in
/// timeseries.csv. `width`: number of values per row (e.g. one per shoe, or three for a vector).
struct Channel {
  std::string path; ///< "vehicle/left/sinkage"
  std::string unit; ///< "m"; "-" if dimensionless
  std::string help;
  int width = 1;
  /// Names of the columns in timeseries.csv: "x","y","z". Empty with `width` > 1: not in timeseries.csv.
  std::vector<std::string> columns;
};

/// Numbers of one output time: `width` numbers per channel, in the order of the channels.
struct Row {
  std::int64_t step{};
  double time{}; ///< [s]
  std::vector<double> values;
};

/// A rigid part in pictures: a mesh that is drawn in each frame at the pose of that frame.
struct FramePart {
  std::string name; ///< "left shoe 12"
  PartKind kind{};
  base::TriangleMesh mesh; ///< in the body frame
};

/// Deformable soil in a frame: triangles, and values at the vertices.
struct SoilSurface {
  base::TriangleMesh mesh;                  ///< in the world frame
  std::vector<float> sinkage;               ///< below the undisturbed surface [m]
  std::vector<float> pressure, maxPressure; ///< current value, and maximum since the start [Pa]
  std::vector<base::Vec3f> shear;           ///< current shear stress on the soil [Pa]
};

/// Particles of a fluid in a frame.
struct FluidPoints {
  std::vector<base::Vec3f> position, velocity; ///< [m], [m/s]
  std::vector<float> pressure;                 ///< [Pa]
  double spacing{};                            ///< initial particle spacing [m]
};

/// Grains and parts at one time; with several ranks, the grains of this rank. All arrays of grains have the same
/// length.
struct Frame {
  std::int64_t step{};
  double time{};                       ///< [s]
  std::vector<base::Vec3f> positions;  ///< [m]
  std::vector<float> radii;            ///< [m]
  std::vector<base::Vec3f> velocities; ///< [m/s]
  /// Resultant of all contact forces on each grain in the last step [N], NaN before the first; empty if frames do
  /// not store them.
  std::vector<base::Vec3f> contactForces;
  bool withContactForces{false}; ///< equal on all ranks, including ranks without grains
  std::vector<float> fixed;      ///< 1 for grains that never move, 0 for others; empty if frames do not store it
  bool withFixed{false};         ///< equal on all ranks
  std::vector<std::uint32_t> ids;
  std::vector<base::Pose> partPoses;                 ///< one per part
  std::shared_ptr<const terrain::SoilFields> fields; ///< fields of the soil, the same on all ranks; may be null
  std::shared_ptr<const SoilSurface> soil;  ///< surface of deformable ground, the same on all ranks; may be null
  std::shared_ptr<const FluidPoints> fluid; ///< fluid particles, the same on all ranks; may be null
  /// Positions of the borders between subdomains along x, y and z, ascending [m]. All empty: one subdomain.
  std::array<std::vector<double>, 3> borders;
};

/// Summary of a run.
struct Summary {
  std::int64_t steps{};
  double simulatedTime{};                ///< [s]
  double wallTime{};                     ///< [s]
  std::string stateHash;                 ///< hexadecimal; empty if not computed
  std::string incomplete;                ///< reason why the vehicle did not drive, or drove too little; empty: complete
  std::map<std::string, double> figures; ///< other figures: "particle steps per second"
};

} // namespace grouser::output

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/records.hpp"

#include <string>
#include <vector>

/// The quantities of a time series: one list for who writes results.h5 and who reads it.
namespace grouser::output {

inline const std::vector<std::string> kAxes = {"x", "y", "z"}; ///< columns of a vector

/// One number a shoe, in the order of the wrap; `side` is "left" or "right".
inline std::string shoeSinkage(const std::string& side) { return "vehicle/" + side + "/sinkage"; }

/// A quantity that another room describes (vehicle::Quantity has the same members).
template <class Quantity> Channel channelOf(const Quantity& q) { return {q.path, q.unit, q.help, q.width, q.columns}; }

/// State of the bed and its contacts.
std::vector<Channel> terrainChannels();
/// Loads on a rigid surface and what moves it, under surfaces/NAME. `hasPivot`: its torque about that too.
std::vector<Channel> surfaceChannels(const std::string& name, bool hasPivot = false);
/// What a vehicle does to a surface at rest, under obstacles/NAME.
std::vector<Channel> obstacleChannels(const std::string& name);
/// What a vehicle pulls at its hitch.
std::vector<Channel> hitchChannels();
/// What grains touch of a vehicle.
std::vector<Channel> gearChannels();
/// Energy and momentum.
std::vector<Channel> ledgerChannels();

/// Fills a row by channel path, in any order. What is not set stays NaN.
class RowBuilder {
public:
  explicit RowBuilder(const std::vector<Channel>& channels);
  void begin(std::int64_t step, double time);
  /// Throws std::logic_error for a path that is no channel or a count that is not its width.
  void set(const std::string& path, double value) { set(path, &value, 1); }
  void set(const std::string& path, const base::Vec3d& v) { set(path, &v.x, 3); }
  void set(const std::string& path, const std::vector<double>& values) { set(path, values.data(), values.size()); }
  /// Fills several channels in a row, of which `first` is the first.
  void setFrom(const std::string& first, const std::vector<double>& values);
  const Row& row() const { return row_; }

private:
  void set(const std::string& path, const double* values, std::size_t count);
  struct Slot {
    std::size_t first, width;
  };
  std::map<std::string, Slot> slots_;
  Row row_;
};

} // namespace grouser::output

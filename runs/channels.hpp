// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output.hpp"

#include <string>
#include <vector>

/// The quantities of a time series: one list for who writes results.h5 and who reads it.
namespace grouser::runs {

/// Per shoe, left track first; `labels(count)` names them "left 0" ... "right 45".
inline constexpr const char* kShoeSinkage = "vehicle/shoes/sinkage";
inline constexpr const char* kShoeHeight = "vehicle/shoes/height";
inline constexpr const char* kShoePosition = "vehicle/shoes/position";
inline constexpr const char* kShoeLoad = "vehicle/shoes/load";
inline constexpr const char* kShoeTension = "vehicle/shoes/tension";

std::vector<std::string> shoeLabels(int shoesPerTrack);
/// Shoes, body, sprockets, tensioner and slip. Order: as in the list, 5 + 4 + 4 + 3 channels.
std::vector<Channel> vehicleChannels(int shoesPerTrack);
/// State of the bed and its contacts.
std::vector<Channel> terrainChannels();
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
  const Row& row() const { return row_; }

private:
  void set(const std::string& path, const double* values, std::size_t count);
  struct Slot {
    std::size_t first, width;
  };
  std::map<std::string, Slot> slots_;
  Row row_;
};

} // namespace grouser::runs

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "runs/output/records.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace grouser::test {

/// Builds a row from the paths of its channels, in any order. Unset values are NaN.
class RowBuilder {
public:
  explicit RowBuilder(const std::vector<output::Channel>& channels) {
    std::size_t first = 0;
    for (const output::Channel& c : channels) {
      slots_[c.path] = {first, static_cast<std::size_t>(c.width)};
      first += static_cast<std::size_t>(c.width);
    }
    row_.values.resize(first);
  }
  void begin(std::int64_t step, double time) {
    row_.step = step, row_.time = time;
    std::fill(row_.values.begin(), row_.values.end(), std::numeric_limits<double>::quiet_NaN());
  }
  void set(const std::string& path, double value) { set(path, std::vector<double>{value}); }
  void set(const std::string& path, const base::Vec3d& v) { set(path, std::vector<double>{v.x, v.y, v.z}); }
  void set(const std::string& path, const std::vector<double>& values) {
    const Slot slot = slots_.at(path);
    if (slot.width != values.size()) throw std::logic_error(path + " takes another count of numbers");
    std::copy(values.begin(), values.end(), row_.values.begin() + static_cast<std::ptrdiff_t>(slot.first));
  }
  const output::Row& row() const { return row_; }

private:
  struct Slot {
    std::size_t first, width;
  };
  std::map<std::string, Slot> slots_;
  output::Row row_;
};

} // namespace grouser::test

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace grouser::session {

/// Distance driven by the vehicle, from the rows of the run.
class DriveRecord {
public:
  DriveRecord() = default;
  explicit DriveRecord(const std::vector<output::Channel>& channels);
  void add(const output::Row& row);

  /// Larger number of teeth passed by a track, both directions counted [-].
  double teeth() const { return std::max(passed_[0], passed_[1]); }

private:
  std::array<std::optional<std::size_t>, 2> at_; ///< column indices in a row, left and right
  std::array<double, 2> last_{}, passed_{};
  bool begun_ = false;
};

} // namespace grouser::session

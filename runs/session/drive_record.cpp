// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/drive_record.hpp"

#include <cmath>

namespace grouser::session {

DriveRecord::DriveRecord(const std::vector<output::Channel>& channels) {
  std::size_t at = 0;
  for (const output::Channel& c : channels) {
    if (c.path == "vehicle/left/teeth_passed") at_[0] = at;
    if (c.path == "vehicle/right/teeth_passed") at_[1] = at;
    at += static_cast<std::size_t>(c.width);
  }
}

void DriveRecord::add(const output::Row& row) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!at_[side]) continue;
    const double now = row.values[*at_[side]];
    if (begun_) passed_[side] += std::fabs(now - last_[side]);
    last_[side] = now;
  }
  begun_ = true;
}

} // namespace grouser::session

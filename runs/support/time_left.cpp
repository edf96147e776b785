// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/time_left.hpp"

#include <algorithm>

namespace grouser::support {

double TimeLeft::window(double elapsed) {
  constexpr double kShortest = 20, kShare = 0.2; // [s], [elapsed time]; work in few large pieces needs a long window
  return std::max(kShortest, kShare * elapsed);
}

void TimeLeft::add(double elapsed, double fraction) {
  constexpr double kSamples = 64; // maximum number in a window
  if (fraction <= samples_.back().fraction) return;
  const double width = window(elapsed);
  // Samples that arrive faster replace the previous sample.
  if (samples_.size() > 2 && elapsed - samples_[samples_.size() - 2].time < width / kSamples) samples_.pop_back();
  samples_.push_back({elapsed, fraction});
  while (samples_.size() > 2 && samples_[1].time <= elapsed - width) samples_.pop_front();
}

std::optional<double> TimeLeft::at(double elapsed) const {
  if (samples_.size() < 2) return {};
  const Sample first = samples_.front(), last = samples_.back();
  const double took = last.time - first.time, idle = elapsed - last.time;
  if (took <= 0 || idle > std::max(took, window(elapsed))) return {};
  const double left = (1 - last.fraction) * took / (last.fraction - first.fraction) - idle;
  return left < 0 ? std::nullopt : std::optional(left);
}

} // namespace grouser::support

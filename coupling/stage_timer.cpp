// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/stage_timer.hpp"

#include <chrono>

namespace grouser::coupling {

namespace {

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

} // namespace

void StageTimer::after(Stage stage) {
  base::synchronize(exec_);
  const std::int64_t at = now();
  parts_[static_cast<std::size_t>(stage)].microseconds += 1e-3 * static_cast<double>(at - last_);
  last_ = at;
}

void StageTimer::step() {
  const terrain::Grains* grains = simulation_.ground().grains.get();
  const std::int64_t before = grains ? grains->system().rebuilds : 0;
  base::synchronize(exec_);
  last_ = now();
  simulation_.step(this);
  if (grains) rebuilds_ += grains->system().rebuilds - before;
  ++steps_;
}

} // namespace grouser::coupling

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "runs/support/stop_signals.hpp"
#include "runs/support/stopwatch.hpp"

#include <algorithm>
#include <cstdint>

namespace grouser::session {

/// Signals received by any rank. All ranks must stop at the same step, so they exchange signals often enough to respond
/// within 0.2 s: launchers that forward an interrupt kill the ranks after one second.
class SignalWatch {
public:
  explicit SignalWatch(const base::Comm& comm) : comm_(comm) {}

  int receivedAt(std::int64_t step) {
    if (comm_.alone()) return support::StopSignals::received();
    if (step < next_) return 0;
    const double perStep = asked_.seconds() / static_cast<double>(std::max<std::int64_t>(1, step - last_));
    std::uint64_t all[] = {static_cast<std::uint64_t>(support::StopSignals::received()),
                           static_cast<std::uint64_t>(1e9 * perStep) + 1};
    comm_.maximum(all, 2);
    constexpr std::uint64_t kWithin = 200'000'000, kMax = 100; // [ns], steps
    last_ = step, next_ = step + static_cast<std::int64_t>(std::clamp<std::uint64_t>(kWithin / all[1], 1, kMax));
    asked_ = {};
    return static_cast<int>(all[0]);
  }

private:
  base::Comm comm_;
  std::int64_t last_ = 0, next_ = 0;
  support::Stopwatch asked_;
};

} // namespace grouser::session

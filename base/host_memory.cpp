// SPDX-License-Identifier: BSD-3-Clause
#include "base/host_memory.hpp"

#include <atomic>
#include <malloc.h>

namespace grouser::base {

namespace {

/// Memory counter of the process; does not affect results.
struct Count {
  std::atomic<std::size_t> now{0}, most{0};
};
Count held;

} // namespace

void noteTaken(void* memory) noexcept {
  const std::size_t now = held.now += malloc_usable_size(memory);
  for (std::size_t before = held.most; now > before && !held.most.compare_exchange_weak(before, now);) {}
}

void noteGivenBack(void* memory) noexcept { held.now -= malloc_usable_size(memory); }

std::size_t heldOnHost() { return held.now; }
std::size_t peakHostMemory() { return held.most; }
void restartHostPeak() { held.most = held.now.load(); }

} // namespace grouser::base

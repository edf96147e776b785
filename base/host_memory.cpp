// SPDX-License-Identifier: BSD-3-Clause
#include "base/host_memory.hpp"

#include <atomic>
#include <malloc.h>

namespace grouser::base {

namespace {

/// Of the process, as the system counts its memory too: no answer depends on it.
struct Count {
  std::atomic<std::size_t> now{0}, most{0};
};
Count count;

} // namespace

void noteTaken(void* memory) noexcept {
  const std::size_t held = count.now += malloc_usable_size(memory);
  for (std::size_t before = count.most; held > before && !count.most.compare_exchange_weak(before, held);) {}
}

void noteGivenBack(void* memory) noexcept { count.now -= malloc_usable_size(memory); }

std::size_t heldOnHost() { return count.now; }
std::size_t mostHeldOnHost() { return count.most; }
void restartHostPeak() { count.most = count.now.load(); }

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
// Loaded before the program (LD_PRELOAD): aligned_alloc, which allocates the arrays on a CPU, fails once,
// at the call number FAIL_ALLOCATION. Prints the number of calls at the end.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <malloc.h>

namespace {

constexpr std::size_t kOfArrays = 64; // their alignment
std::atomic<long> calls = 0;

struct Tell {
  ~Tell() { std::fprintf(stderr, "allocations %ld\n", calls.load()); }
} const kTell;

} // namespace

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  static const char* const fails = std::getenv("FAIL_ALLOCATION");
  if (alignment == kOfArrays && ++calls == (fails ? std::atol(fails) : 0)) return nullptr;
  return memalign(alignment, size);
}

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each.cuh"

namespace grouser::base {

/// Threads that share one item of forEachGroup: `width` neighbouring threads of a warp on the GPU, one on the CPU. They
/// traverse a list together (for k = lane; k < n; k += width) and reduce to the best entry.
template <int kWidth> struct ThreadGroup {
  static constexpr int width = kWidth;
  int rank;

  /// Sets `value` to the maximum over the group and `key` to the smallest key among equal maxima, in every thread.
  template <class T> GROUSER_HD void agreeOnGreatest(T& value, std::uint32_t& key) const {
#if defined(__CUDA_ARCH__)
    const unsigned self = threadIdx.x & 31u;
    const unsigned group = kWidth == 32 ? ~0u : ((1u << (kWidth & 31)) - 1u) << (self & ~(kWidth - 1u));
    for (int apart = kWidth / 2; apart > 0; apart /= 2) {
      const T otherValue = __shfl_xor_sync(group, value, apart);
      const std::uint32_t otherKey = __shfl_xor_sync(group, key, apart);
      if (otherValue > value || (otherValue == value && otherKey < key)) value = otherValue, key = otherKey;
    }
#else
    (void)value, (void)key;
#endif
  }
};

namespace detail {
/// Runs the items of one CPU thread.
template <class Body> void runGroups(const Body& body, std::int64_t first, std::int64_t last) {
  if constexpr (requires { body.runOnCpu(first, last); })
    body.runOnCpu(first, last);
  else
    for (std::int64_t i = first; i < last; ++i) body(static_cast<int>(i), ThreadGroup<1>{0});
}
} // namespace detail

#if defined(__CUDACC__)
namespace detail {
inline constexpr int kGroupBlock = 64; // threads per block; small blocks fit beside large kernels
template <int kWidth, class Body> __global__ void __launch_bounds__(kGroupBlock)
    forEachGroupKernel(Body body, std::int64_t count) {
  const std::int64_t thread = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  const std::int64_t i = thread / kWidth;
  if (i < count) body(static_cast<int>(i), ThreadGroup<kWidth>{static_cast<int>(thread % kWidth)});
}
} // namespace detail
#endif

/// Runs `body(i, group)` for i in [0, count) like forEach, but with `kWidth` GPU threads (a power of two up to 32) per
/// item, for bodies that traverse lists too long for one thread. On the CPU, a body with a member runOnCpu(first, last)
/// receives the whole range of a thread in one call.
template <int kWidth, class Body>
void forEachGroup(const Exec& exec, const char* name, std::int64_t count, const Body& body) {
  if (count <= 0) return;
  if (exec.onCpu()) {
    const std::int64_t threads = threadsForLoop(count, nanosecondsOf(body), exec.threads);
#pragma omp parallel for schedule(static, 1) num_threads(static_cast <int>(threads)) if (threads > 1)
    for (std::int64_t t = 0; t < threads; ++t) detail::runGroups(body, count * t / threads, count * (t + 1) / threads);
    return;
  }
#if defined(__CUDACC__)
  constexpr int kBlock = detail::kGroupBlock;
  const auto blocks = static_cast<unsigned>((count * kWidth + kBlock - 1) / kBlock);
  detail::forEachGroupKernel<kWidth><<<blocks, kBlock, 0, static_cast<cudaStream_t>(exec.stream)>>>(body, count);
  checkCuda(cudaGetLastError(), std::string("launch of ") + name);
#else
  throw DeviceError(std::string(name) + ": this file was not compiled for CUDA");
#endif
}

} // namespace grouser::base

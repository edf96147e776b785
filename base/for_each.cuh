// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.hpp"
#include "base/exec.hpp"
#include "base/host_device.hpp"
#include "base/loop_shares.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

#if defined(__CUDACC__)
#include "base/cuda_check.cuh"
#endif

namespace grouser::base {

/// Approximate cost of a loop item on one core [ns]: the body's `static constexpr double kNanoseconds` or `double
/// nanoseconds() const`, otherwise the cost of a few memory accesses. It determines only whether the loop is threaded.
template <class Body> double nanosecondsOf(const Body& body) {
  if constexpr (requires { body.nanoseconds(); })
    return body.nanoseconds();
  else if constexpr (requires { Body::kNanoseconds; })
    return Body::kNanoseconds;
  else
    return 5;
}

/// Minimum number of resident blocks per GPU multiprocessor, which limits the registers per thread: the body's `static
/// constexpr int kBlocksTogether`, or 0 for no limit.
template <class Body> constexpr int blocksTogether() {
  if constexpr (requires { Body::kBlocksTogether; })
    return Body::kBlocksTogether;
  else
    return 0;
}

#if defined(__CUDACC__)
namespace detail {
template <class Body> __global__ void __launch_bounds__(128, blocksTogether<Body>())
    forEachKernel(Body body, std::int64_t count) {
  const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < count) body(static_cast<int>(i));
}
} // namespace detail
#endif

/// Runs `body(i)` for i in [0, count), in any order: on the CPU as an OpenMP loop, threaded if the loop is long enough
/// (nanosecondsOf()); on the GPU asynchronously as one kernel. `body` is a named functor of pointers and scalars; error
/// messages contain `name`.
template <class Body> void forEach(const Exec& exec, const char* name, std::int64_t count, const Body& body) {
  if (count <= 0) return;
  if (exec.onCpu()) {
    const int n = static_cast<int>(count);
    [[maybe_unused]] const int threads = threadsForLoop(count, nanosecondsOf(body), exec.threads);
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int i = 0; i < n; ++i) body(i);
    return;
  }
#if defined(__CUDACC__)
  constexpr int kBlock = 128;
  const auto blocks = static_cast<unsigned>((count + kBlock - 1) / kBlock);
  detail::forEachKernel<<<blocks, kBlock, 0, static_cast<cudaStream_t>(exec.stream)>>>(body, count);
  checkCuda(cudaGetLastError(), std::string("launch of ") + name);
#else
  // Only files compiled by nvcc can launch kernels.
  throw DeviceError(std::string(name) + ": this file was not compiled for CUDA");
#endif
}

/// Adds to a counter shared by threads; an integer sum does not depend on the order.
GROUSER_HD void atomicAdd64(std::int64_t* target, std::int64_t value) {
#if defined(__CUDA_ARCH__)
  atomicAdd(reinterpret_cast<unsigned long long*>(target), static_cast<unsigned long long>(value));
#else
  __atomic_fetch_add(target, value, __ATOMIC_RELAXED);
#endif
}

GROUSER_HD std::uint32_t atomicAdd32(std::uint32_t* target, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(target, value);
#else
  return __atomic_fetch_add(target, value, __ATOMIC_RELAXED);
#endif
}

/// Atomic maximum, preceded by a plain read; a stale value costs only one unnecessary atomic operation.
GROUSER_HD void atomicMax32(std::uint32_t* target, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
  if (value > *target) atomicMax(target, value);
#else
  std::uint32_t old = __atomic_load_n(target, __ATOMIC_RELAXED);
  while (value > old && !__atomic_compare_exchange_n(target, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {}
#endif
}

/// Sets bit 0 of a shared flag word. Concurrent writers all set the same bit, so their order does not matter.
GROUSER_HD void raise(std::uint32_t* flag) {
#if defined(__CUDA_ARCH__)
  atomicOr(flag, 1u);
#else
  __atomic_store_n(flag, 1u, __ATOMIC_RELAXED);
#endif
}

/// Atomic minimum: keeps the fault with the smallest key, independent of the thread that finds it.
GROUSER_HD void atomicMin64(std::uint64_t* target, std::uint64_t value) {
#if defined(__CUDA_ARCH__)
  atomicMin(reinterpret_cast<unsigned long long*>(target), static_cast<unsigned long long>(value));
#else
  std::uint64_t old = __atomic_load_n(target, __ATOMIC_RELAXED);
  while (value < old && !__atomic_compare_exchange_n(target, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {}
#endif
}

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#include "base/algorithms.hpp"

#include "base/cpu_algorithms.hpp"

#if defined(__CUDACC__)
#include "base/host_device.hpp"

#include <thrust/copy.h>
#include <thrust/execution_policy.h>
#include <thrust/functional.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>
#include <thrust/sequence.h>
#include <thrust/sort.h>
#include <thrust/system/cuda/execution_policy.h>
#endif

namespace grouser::base {

#if defined(__CUDACC__)
namespace {

/// Thrust's own memory for a moment, from the pool that Array takes its from.
struct PoolAllocator {
  using value_type = char;
  const Exec& exec;
  char* allocate(std::ptrdiff_t bytes) {
    return static_cast<char*>(allocateUnset(exec, static_cast<std::size_t>(bytes)));
  }
  void deallocate(char* memory, std::size_t) { release(exec, memory); }
};

/// Thrust's policy for `exec` and its memory.
auto policyOf(const Exec& exec, PoolAllocator& pool) {
  return thrust::cuda::par_nosync(pool).on(static_cast<cudaStream_t>(exec.stream));
}

struct IsMarked {
  GROUSER_HD bool operator()(std::uint32_t mark) const { return mark != 0; }
};

} // namespace
#endif

void sortByKey(const Exec& exec, std::uint64_t* keys, std::uint32_t* values, std::size_t count) {
  if (exec.onCpu()) return cpu::sortByKey(exec, keys, values, count);
#if defined(__CUDACC__)
  PoolAllocator pool{exec};
  if (count) thrust::stable_sort_by_key(policyOf(exec, pool), keys, keys + count, values);
#endif
}

std::uint32_t exclusiveScan(const Exec& exec, const std::uint32_t* in, std::uint32_t* out, std::size_t count) {
  if (count == 0) return 0;
  if (exec.onCpu()) return cpu::exclusiveScan(exec, in, out, count);
  std::uint32_t lastIn = 0, lastOut = 0;
#if defined(__CUDACC__)
  PoolAllocator pool{exec};
  copyToHost(exec, &lastIn, in + count - 1, sizeof lastIn);
  thrust::exclusive_scan(policyOf(exec, pool), in, in + count, out, 0u);
  copyToHost(exec, &lastOut, out + count - 1, sizeof lastOut);
#endif
  return lastOut + lastIn;
}

std::uint32_t maximum(const Exec& exec, const std::uint32_t* values, std::size_t count) {
  if (exec.onCpu()) return cpu::maximum(exec, values, count);
#if defined(__CUDACC__)
  PoolAllocator pool{exec};
  if (count) return thrust::reduce(policyOf(exec, pool), values, values + count, 0u, thrust::maximum<std::uint32_t>());
#endif
  return 0;
}

void listMarked(const Exec& exec, const std::uint32_t* marks, std::size_t count, Array<std::uint32_t>& list) {
  list.resize(count);
  std::size_t found = 0;
  if (exec.onCpu()) found = cpu::listMarked(exec, marks, count, list.data());
#if defined(__CUDACC__)
  PoolAllocator pool{exec};
  const thrust::counting_iterator<std::uint32_t> first(0);
  if (!exec.onCpu() && count)
    found = static_cast<std::size_t>(thrust::copy_if(policyOf(exec, pool), first,
                                                     first + static_cast<std::ptrdiff_t>(count), marks, list.data(),
                                                     IsMarked{}) -
                                     list.data());
#endif
  list.resize(found);
}

void iota(const Exec& exec, std::uint32_t* out, std::size_t count) {
  if (exec.onCpu()) return cpu::iota(exec, out, count);
#if defined(__CUDACC__)
  PoolAllocator pool{exec};
  if (count) thrust::sequence(policyOf(exec, pool), out, out + count);
#endif
}

} // namespace grouser::base

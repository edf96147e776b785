// SPDX-License-Identifier: BSD-3-Clause
#include "base/algorithms.hpp"

#include "base/host_device.hpp"

#if !defined(__CUDACC__)
#define THRUST_DEVICE_SYSTEM THRUST_DEVICE_SYSTEM_OMP // avoids CUDA headers on machines without the toolkit
#endif

#include <omp.h>
#include <thrust/copy.h>
#include <thrust/execution_policy.h>
#include <thrust/functional.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>
#include <thrust/sequence.h>
#include <thrust/sort.h>
#include <thrust/system/omp/execution_policy.h>

#if defined(__CUDACC__)
#include <thrust/system/cuda/execution_policy.h>
#endif

namespace grouser::base {

namespace {

#if defined(__CUDACC__)
/// Allocator of Thrust's temporary memory from the same pool as Array.
struct PoolAllocator {
  using value_type = char;
  const Exec& exec;
  char* allocate(std::ptrdiff_t bytes) {
    return static_cast<char*>(allocateUnset(exec, static_cast<std::size_t>(bytes)));
  }
  void deallocate(char* memory, std::size_t) { release(exec, memory); }
};
#endif

/// Calls `work(policy)` with Thrust's policy for `exec`.
template <class Work> auto withPolicy(const Exec& exec, const Work& work) {
#if defined(__CUDACC__)
  if (!exec.onCpu()) {
    PoolAllocator pool{exec};
    return work(thrust::cuda::par_nosync(pool).on(static_cast<cudaStream_t>(exec.stream)));
  }
#endif
  omp_set_num_threads(exec.threads);
  return work(thrust::omp::par);
}

struct Sort {
  std::uint64_t* keys;
  std::uint32_t* values;
  std::size_t count;
  template <class Policy> int operator()(const Policy& policy) const {
    thrust::stable_sort_by_key(policy, keys, keys + count, values);
    return 0;
  }
};

struct Scan {
  const std::uint32_t* in;
  std::uint32_t* out;
  std::size_t count;
  template <class Policy> int operator()(const Policy& policy) const {
    thrust::exclusive_scan(policy, in, in + count, out, 0u);
    return 0;
  }
};

struct IsMarked {
  GROUSER_HD bool operator()(std::uint32_t mark) const { return mark != 0; }
};

struct ListMarked {
  const std::uint32_t* marks;
  std::size_t count;
  std::uint32_t* list;
  template <class Policy> std::size_t operator()(const Policy& policy) const {
    const thrust::counting_iterator<std::uint32_t> first(0);
    return static_cast<std::size_t>(
        thrust::copy_if(policy, first, first + static_cast<std::ptrdiff_t>(count), marks, list, IsMarked{}) - list);
  }
};

struct Maximum {
  const std::uint32_t* values;
  std::size_t count;
  template <class Policy> std::uint32_t operator()(const Policy& policy) const {
    return thrust::reduce(policy, values, values + count, 0u, thrust::maximum<std::uint32_t>());
  }
};

struct Sum {
  const std::uint32_t* values;
  std::size_t count;
  template <class Policy> std::uint64_t operator()(const Policy& policy) const {
    return thrust::reduce(policy, values, values + count, std::uint64_t{0}, thrust::plus<std::uint64_t>());
  }
};

struct Sequence {
  std::uint32_t* out;
  std::size_t count;
  template <class Policy> int operator()(const Policy& policy) const {
    thrust::sequence(policy, out, out + count);
    return 0;
  }
};

} // namespace

void sortByKey(const Exec& exec, std::uint64_t* keys, std::uint32_t* values, std::size_t count) {
  if (count) withPolicy(exec, Sort{keys, values, count});
}

std::uint32_t exclusiveScan(const Exec& exec, const std::uint32_t* in, std::uint32_t* out, std::size_t count) {
  if (count == 0) return 0;
  std::uint32_t lastIn = 0, lastOut = 0;
  copyToHost(exec, &lastIn, in + count - 1, sizeof lastIn);
  withPolicy(exec, Scan{in, out, count});
  copyToHost(exec, &lastOut, out + count - 1, sizeof lastOut);
  return lastOut + lastIn;
}

std::uint32_t maximum(const Exec& exec, const std::uint32_t* values, std::size_t count) {
  return count ? withPolicy(exec, Maximum{values, count}) : 0u;
}

std::uint64_t sum(const Exec& exec, const std::uint32_t* values, std::size_t count) {
  return count ? withPolicy(exec, Sum{values, count}) : 0u;
}

void listMarked(const Exec& exec, const std::uint32_t* marks, std::size_t count, Array<std::uint32_t>& list) {
  list.resize(count);
  list.resize(count == 0 ? 0 : withPolicy(exec, ListMarked{marks, count, list.data()}));
}

void iota(const Exec& exec, std::uint32_t* out, std::size_t count) {
  if (count) withPolicy(exec, Sequence{out, count});
}

} // namespace grouser::base

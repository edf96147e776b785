// SPDX-License-Identifier: BSD-3-Clause
#include "base/memory_held.hpp"

#include "base/error.hpp"

#include <atomic>
#include <cstdint>
#include <malloc.h>

#if defined(__CUDACC__)
#include "base/cuda_check.cuh"
#endif

namespace grouser::base {

namespace {

/// Of the process, as the system counts its memory too: no answer depends on it.
struct HostCount {
  std::atomic<std::size_t> now{0}, most{0};
};
HostCount onHost;

#if defined(__CUDACC__)
cudaMemPool_t currentPool() {
  int index = 0;
  cudaMemPool_t pool = nullptr;
  checkCuda(cudaGetDevice(&index), "cudaGetDevice");
  checkCuda(cudaDeviceGetDefaultMemPool(&pool, index), "cudaDeviceGetDefaultMemPool");
  return pool;
}

std::size_t countOf(cudaMemPoolAttr what) {
  std::uint64_t bytes = 0;
  checkCuda(cudaMemPoolGetAttribute(currentPool(), what, &bytes), "cudaMemPoolGetAttribute");
  return bytes;
}
#else
[[noreturn]] void noCuda() { throw DeviceError("this build has no CUDA backend"); }
#endif

} // namespace

void noteTaken(void* memory) noexcept {
  const std::size_t held = onHost.now += malloc_usable_size(memory);
  for (std::size_t before = onHost.most; held > before && !onHost.most.compare_exchange_weak(before, held);) {}
}

void noteGivenBack(void* memory) noexcept { onHost.now -= malloc_usable_size(memory); }

MemoryHeld memoryHeld(const Exec& exec) {
  if (exec.onCpu()) return {onHost.now, onHost.most, onHost.most};
#if defined(__CUDACC__)
  return {countOf(cudaMemPoolAttrUsedMemCurrent), countOf(cudaMemPoolAttrUsedMemHigh),
          countOf(cudaMemPoolAttrReservedMemHigh)};
#else
  noCuda();
#endif
}

void restartMemoryPeak(const Exec& exec) {
  if (exec.onCpu()) {
    onHost.most = onHost.now.load();
    return;
  }
#if defined(__CUDACC__)
  synchronize(exec);
  std::uint64_t none = 0; // the one value that CUDA takes: from what is held now
  for (const cudaMemPoolAttr peak : {cudaMemPoolAttrUsedMemHigh, cudaMemPoolAttrReservedMemHigh})
    checkCuda(cudaMemPoolSetAttribute(currentPool(), peak, &none), "cudaMemPoolSetAttribute");
#else
  noCuda();
#endif
}

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#include "base/memory_held.hpp"

#include "base/error.hpp"
#include "base/host_memory.hpp"

#include <cstdint>

#if defined(__CUDACC__)
#include "base/cuda_check.cuh"
#endif

namespace grouser::base {

namespace {

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

MemoryHeld memoryHeld(const Exec& exec) {
  if (exec.onCpu()) return {heldOnHost(), peakHostMemory(), peakHostMemory()};
#if defined(__CUDACC__)
  return {countOf(cudaMemPoolAttrUsedMemCurrent), countOf(cudaMemPoolAttrUsedMemHigh),
          countOf(cudaMemPoolAttrReservedMemHigh)};
#else
  noCuda();
#endif
}

void restartMemoryPeak(const Exec& exec) {
  if (exec.onCpu()) return restartHostPeak();
#if defined(__CUDACC__)
  synchronize(exec);
  std::uint64_t none = 0; // 0 is the only value that CUDA accepts; it resets the peak to the current size
  for (const cudaMemPoolAttr peak : {cudaMemPoolAttrUsedMemHigh, cudaMemPoolAttrReservedMemHigh})
    checkCuda(cudaMemPoolSetAttribute(currentPool(), peak, &none), "cudaMemPoolSetAttribute");
#else
  noCuda();
#endif
}

} // namespace grouser::base

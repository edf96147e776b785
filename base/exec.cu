// SPDX-License-Identifier: BSD-3-Clause
#include "base/exec.hpp"

#include "base/counted.hpp"
#include "base/cpu_threads.hpp"
#include "base/error.hpp"
#include "base/host_memory.hpp"
#include "base/loop_shares.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <omp.h>
#include <sys/resource.h>

#if defined(__CUDACC__)
#include "base/cuda_check.cuh"
#endif

namespace grouser::base {

namespace {

constexpr std::size_t kAlignment = 64;

#if !defined(__CUDACC__)
[[noreturn]] void noCuda() {
  throw DeviceError("this build has no CUDA backend; use --device cpu, or build with the preset 'cuda'");
}
#endif

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

/// Reason why a CUDA build cannot use a GPU of this machine; empty if a GPU is usable or the build has no CUDA.
std::string whyNoGpu() {
#if defined(__CUDACC__)
  int count = 0, driver = 0;
  const cudaError_t code = cudaGetDeviceCount(&count);
  if (code == cudaSuccess) return count > 0 ? "" : "none found by the driver";
  // The runtime reports a missing driver as a driver that is too old.
  if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) return "NVIDIA's driver is not installed";
  return cudaGetErrorString(code);
#else
  return {};
#endif
}

} // namespace

Exec cpuExec(int threads) {
  Exec exec;
  // OMP_THREAD_LIMIT also limits an explicit number.
  exec.threads = threads > 0 ? std::min(threads, omp_get_thread_limit()) : cpuThreads().count;
  return exec;
}

#if defined(__CUDACC__)

int cudaDevices() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess ? count : 0;
}

Exec cudaExec(int index) {
  if (const std::string why = whyNoGpu(); !why.empty())
    throw DeviceError("no usable GPU: " + why + "; run nvidia-smi to list GPUs, or use --device cpu");
  checkCuda(cudaSetDevice(index), "cudaSetDevice");
  // The pool retains released memory for later allocations: driver calls take longer than most kernels.
  cudaMemPool_t pool = nullptr;
  checkCuda(cudaDeviceGetDefaultMemPool(&pool, index), "cudaDeviceGetDefaultMemPool");
  std::uint64_t all = ~std::uint64_t{0};
  checkCuda(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &all), "cudaMemPoolSetAttribute");
  // Use a priority between the priorities of the side streams (SideStream).
  int last = 0, greatest = 0;
  checkCuda(cudaDeviceGetStreamPriorityRange(&last, &greatest), "cudaDeviceGetStreamPriorityRange");
  cudaStream_t stream = nullptr;
  checkCuda(cudaStreamCreateWithPriority(&stream, cudaStreamNonBlocking, (last + greatest) / 2), "cudaStreamCreate");
  Exec exec;
  exec.device = Device::Cuda;
  exec.stream = stream;
  return exec;
}

#else

int cudaDevices() { return 0; }
Exec cudaExec(int) { noCuda(); }

#endif

bool cudaAvailable() { return cudaDevices() > 0; }

std::string describe(const Exec& exec) {
  if (exec.onCpu()) {
    const std::string why = whyNoGpu();
    const CpuThreads usual = lowestLimit(threadLimits());
    // Ranks on one machine share its cores and have fewer threads than the limit.
    const std::string limit = usual.cause.empty() || exec.threads < usual.count
                                  ? ""
                                  : "; default: " + std::to_string(usual.count) + " of " +
                                        counted(usual.machine, "core") + " (" + usual.cause + ")";
    return counted(exec.threads, "thread") + " on " + processorName() + limit + (why.empty() ? "" : "; no GPU: " + why);
  }
#if defined(__CUDACC__)
  int index = 0;
  cudaDeviceProp properties{};
  checkCuda(cudaGetDevice(&index), "cudaGetDevice");
  checkCuda(cudaGetDeviceProperties(&properties, index), "cudaGetDeviceProperties");
  return std::string(properties.name) + ", " + std::to_string(properties.totalGlobalMem >> 30) + " GiB";
#else
  noCuda();
#endif
}

int multiprocessors(const Exec& exec) {
  if (exec.onCpu()) return 0;
#if defined(__CUDACC__)
  int index = 0, count = 0;
  checkCuda(cudaGetDevice(&index), "cudaGetDevice");
  checkCuda(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, index), "cudaDeviceGetAttribute");
  return count;
#else
  noCuda();
#endif
}

std::uint64_t deviceId(const Exec& exec) {
  if (exec.onCpu()) return 0;
#if defined(__CUDACC__)
  int index = 0;
  cudaDeviceProp properties{};
  checkCuda(cudaGetDevice(&index), "cudaGetDevice");
  checkCuda(cudaGetDeviceProperties(&properties, index), "cudaGetDeviceProperties");
  std::uint64_t id = 0;
  for (const char byte : properties.uuid.bytes) id = id * 0x100000001b3u ^ static_cast<unsigned char>(byte); // as FNV
  return id;
#else
  noCuda();
#endif
}

std::size_t usedMemory(const Exec& exec) {
  if (exec.onCpu()) {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024; // Linux reports KiB
  }
#if defined(__CUDACC__)
  std::size_t unused = 0, total = 0;
  checkCuda(cudaMemGetInfo(&unused, &total), "cudaMemGetInfo");
  return total - unused;
#else
  noCuda();
#endif
}

void synchronize(const Exec& exec) {
  if (exec.onCpu()) return;
#if defined(__CUDACC__)
  checkCuda(cudaStreamSynchronize(static_cast<cudaStream_t>(exec.stream)), "cudaStreamSynchronize");
#endif
}

bool isBusy(const Exec& exec) {
  if (exec.onCpu()) return false;
#if defined(__CUDACC__)
  const cudaError_t state = cudaStreamQuery(static_cast<cudaStream_t>(exec.stream));
  if (state == cudaErrorNotReady) return true;
  checkCuda(state, "cudaStreamQuery");
#endif
  return false;
}

#if defined(__CUDACC__)
namespace {

/// Returns to the system all memory that the pool keeps for later allocations.
void emptyPool(const Exec& exec) {
  synchronize(exec);
  int index = 0;
  cudaMemPool_t pool = nullptr;
  checkCuda(cudaGetDevice(&index), "cudaGetDevice");
  checkCuda(cudaDeviceGetDefaultMemPool(&pool, index), "cudaDeviceGetDefaultMemPool");
  checkCuda(cudaMemPoolTrimTo(pool, 0), "cudaMemPoolTrimTo");
}

DeviceError outOfMemory(std::size_t bytes) {
  const auto inMiB = [](std::size_t count) { return std::to_string((count + (1u << 20) - 1) >> 20) + " MiB"; };
  std::size_t unused = 0, total = 0;
  int index = 0;
  cudaGetLastError(); // clears the error: the exception reports it
  if (cudaGetDevice(&index) != cudaSuccess || cudaMemGetInfo(&unused, &total) != cudaSuccess) unused = total = 0;
  return DeviceError("GPU " + std::to_string(index) + " is out of memory: " + inMiB(bytes) + " more required, " +
                     inMiB(unused) + " of " + inMiB(total) +
                     " free; stop other programs on it, use more GPUs or ranks, or fewer grains (grouser plan SCENE "
                     "estimates the memory)");
}

} // namespace
#endif

void* allocateUnset(const Exec& exec, std::size_t bytes) {
  if (bytes == 0) return nullptr;
  void* memory = nullptr;
  if (exec.onCpu()) {
    memory = std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment);
    if (!memory)
      throw DeviceError("out of host memory: " + std::to_string(bytes) +
                        " bytes requested; use larger or fewer grains, or more ranks on several hosts");
    noteTaken(memory);
    return memory;
  }
#if defined(__CUDACC__)
  cudaError_t code = cudaMallocAsync(&memory, bytes, static_cast<cudaStream_t>(exec.stream));
  if (code == cudaErrorMemoryAllocation) {
    // The pool may contain fragments that are too small; they merge when returned to the system.
    cudaGetLastError();
    emptyPool(exec);
    code = cudaMallocAsync(&memory, bytes, static_cast<cudaStream_t>(exec.stream));
  }
  if (code == cudaErrorMemoryAllocation) throw outOfMemory(bytes);
  checkCuda(code, "cudaMallocAsync of " + std::to_string(bytes) + " bytes");
  return memory;
#else
  noCuda();
#endif
}

void* allocate(const Exec& exec, std::size_t bytes) {
  void* memory = allocateUnset(exec, bytes);
  setZero(exec, memory, bytes);
  return memory;
}

void* allocateForMessages(const Exec& exec, std::size_t bytes) {
  if (exec.onCpu() || bytes == 0) return allocateUnset(exec, bytes);
#if defined(__CUDACC__)
  void* memory = nullptr;
  const cudaError_t code = cudaMalloc(&memory, bytes);
  if (code == cudaErrorMemoryAllocation) throw outOfMemory(bytes);
  checkCuda(code, "cudaMalloc of " + std::to_string(bytes) + " bytes");
  return memory;
#else
  noCuda();
#endif
}

void releaseForMessages(const Exec& exec, void* memory) noexcept {
  if (exec.onCpu()) return release(exec, memory);
#if defined(__CUDACC__)
  cudaFree(memory);
#endif
}

void release(const Exec& exec, void* memory) noexcept {
  if (exec.onCpu()) {
    noteGivenBack(memory);
    std::free(memory);
    return;
  }
#if defined(__CUDACC__)
  if (memory) cudaFreeAsync(memory, static_cast<cudaStream_t>(exec.stream)); // failures during unwinding are ignored
#endif
}

void copyToDevice(const Exec& exec, void* device, const void* host, std::size_t bytes) {
  if (bytes == 0) return;
  if (exec.onCpu()) {
    std::memcpy(device, host, bytes);
    return;
  }
#if defined(__CUDACC__)
  auto stream = static_cast<cudaStream_t>(exec.stream);
  checkCuda(cudaMemcpyAsync(device, host, bytes, cudaMemcpyHostToDevice, stream), "copy to device");
  checkCuda(cudaStreamSynchronize(stream), "copy to device");
#endif
}

void copyToHost(const Exec& exec, void* host, const void* device, std::size_t bytes) {
  if (bytes == 0) return;
  if (exec.onCpu()) {
    std::memcpy(host, device, bytes);
    return;
  }
#if defined(__CUDACC__)
  auto stream = static_cast<cudaStream_t>(exec.stream);
  checkCuda(cudaMemcpyAsync(host, device, bytes, cudaMemcpyDeviceToHost, stream), "copy to host");
  checkCuda(cudaStreamSynchronize(stream), "copy to host");
#endif
}

void* allocatePinned(const Exec& exec, std::size_t bytes) {
  if (exec.onCpu() || bytes == 0) return allocate(exec, bytes);
#if defined(__CUDACC__)
  void* memory = nullptr;
  checkCuda(cudaMallocHost(&memory, bytes), "cudaMallocHost of " + std::to_string(bytes) + " bytes");
  std::memset(memory, 0, bytes);
  return memory;
#else
  noCuda();
#endif
}

void releasePinned(const Exec& exec, void* memory) noexcept {
  if (exec.onCpu()) return release(exec, memory);
#if defined(__CUDACC__)
  cudaFreeHost(memory);
#endif
}

void copyToDeviceLater(const Exec& exec, void* device, const void* host, std::size_t bytes) {
  if (exec.onCpu()) return copyToDevice(exec, device, host, bytes);
#if defined(__CUDACC__)
  checkCuda(cudaMemcpyAsync(device, host, bytes, cudaMemcpyHostToDevice, static_cast<cudaStream_t>(exec.stream)),
            "copy to device");
#endif
}

void copyToHostLater(const Exec& exec, void* host, const void* device, std::size_t bytes) {
  if (exec.onCpu()) return copyToHost(exec, host, device, bytes);
#if defined(__CUDACC__)
  checkCuda(cudaMemcpyAsync(host, device, bytes, cudaMemcpyDeviceToHost, static_cast<cudaStream_t>(exec.stream)),
            "copy to host");
#endif
}

void copyOnDevice(const Exec& exec, void* to, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
  if (exec.onCpu()) {
    copyShared(to, from, bytes, exec.threads);
    return;
  }
#if defined(__CUDACC__)
  checkCuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, static_cast<cudaStream_t>(exec.stream)),
            "copy on device");
#endif
}

void setZero(const Exec& exec, void* device, std::size_t bytes) {
  if (bytes == 0) return;
  if (exec.onCpu()) {
    zeroShared(device, bytes, exec.threads);
    return;
  }
#if defined(__CUDACC__)
  checkCuda(cudaMemsetAsync(device, 0, bytes, static_cast<cudaStream_t>(exec.stream)), "set to zero");
#endif
}

} // namespace grouser::base

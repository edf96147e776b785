// SPDX-License-Identifier: BSD-3-Clause
#include "base/gate.hpp"

#include "base/for_each.cuh"
#include "base/parcel_words.cuh"

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>

#if defined(__CUDACC__)
#include <cuda/atomic>
#endif

namespace grouser::base {

#if defined(__CUDACC__)

namespace {

constexpr int kBlock = 128; // a single block, since its threads wait for each other; runs beside other kernels

cudaStream_t streamOf(const Exec& exec) { return static_cast<cudaStream_t>(exec.stream); }

__device__ bool raised(const Watch& watch) {
  const auto* at = static_cast<const std::uint64_t*>(watch.at);
  return at && (at[0] != watch.idle[0] || at[1] != watch.idle[1]);
}

__global__ void __launch_bounds__(128) carryBeforeGate(Watch watch, ParcelWords words) {
  const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < words.count() && !raised(watch)) words(i);
}

/// Reads many words before it writes the first, since each access to host memory takes a microsecond.
__device__ void carryTogether(const ParcelWords& words) {
  constexpr int kAtOnce = 10;
  for (std::int64_t first = threadIdx.x; first < words.count(); first += kAtOnce * kBlock) {
    std::uint64_t held[kAtOnce];
#pragma unroll
    for (int k = 0; k < kAtOnce; ++k)
      if (first + k * kBlock < words.count()) held[k] = words.read(first + k * kBlock);
#pragma unroll
    for (int k = 0; k < kAtOnce; ++k)
      if (first + k * kBlock < words.count()) words.write(first + k * kBlock, held[k]);
  }
}

__global__ void __launch_bounds__(kBlock)
    passGate(Watch watch, std::uint64_t* opened, std::uint64_t* runs, std::uint32_t* off, ParcelWords words) {
  __shared__ bool through;
  if (threadIdx.x == 0) {
    through = !raised(watch);
    if (through) {
      const std::uint64_t ticket = ++*runs;
      const cuda::atomic_ref<std::uint64_t, cuda::thread_scope_system> door(*opened);
      std::uint64_t now = door.load(cuda::memory_order_acquire);
      while (now < ticket) now = door.load(cuda::memory_order_acquire);
      through = now != ~std::uint64_t{0};
    }
    *off = through ? 0u : 1u;
  }
  __syncthreads();
  if (through) carryTogether(words);
}

__global__ void __launch_bounds__(kBlock)
    signalHost(const std::uint32_t* off, std::uint64_t* count, std::uint64_t* signalled, ParcelWords words) {
  if (*off) return;
  carryTogether(words);
  __threadfence_system();
  __syncthreads();
  if (threadIdx.x != 0) return;
  const cuda::atomic_ref<std::uint64_t, cuda::thread_scope_system> answer(*signalled);
  answer.store(++*count, cuda::memory_order_release);
}

} // namespace

#endif

Gate::Gate(const Exec& exec) : exec_(exec), words_(exec, 3), passed_(exec, 1) {
  static_assert(std::atomic_ref<std::uint64_t>::is_always_lock_free);
}

bool Gate::canWait(const Exec& exec) {
  const char* blocking = std::getenv("CUDA_LAUNCH_BLOCKING");
  return !exec.onCpu() && !(blocking && std::string(blocking) == "1");
}

#if defined(__CUDACC__)

void Gate::carryBefore(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels) {
  const ParcelWords words(parcels);
  if (exec.onCpu()) return words.onHost();
  const auto blocks = static_cast<unsigned>((words.count() + 127) / 128);
  if (blocks == 0) return;
  carryBeforeGate<<<blocks, 128, 0, streamOf(exec)>>>(watch, words);
  checkCuda(cudaGetLastError(), "launch of carryBefore");
}

void Gate::pass(const Exec& exec, const Watch& watch, std::span<const Parcel> parcels) {
  const ParcelWords words(parcels);
  if (exec.onCpu()) return words.onHost();
  Passed* const p = passed_.data();
  passGate<<<1, kBlock, 0, streamOf(exec)>>>(watch, &words_.host()[0].value, &p->runs, &p->off, words);
  checkCuda(cudaGetLastError(), "launch of pass");
}

void Gate::signal(const Exec& exec, Mark mark, std::span<const Parcel> parcels) {
  const ParcelWords words(parcels);
  if (exec.onCpu()) return words.onHost();
  Passed* const p = passed_.data();
  signalHost<<<1, kBlock, 0, streamOf(exec)>>>(&p->off, &p->signalled[mark], &words_.host()[1 + mark].value, words);
  checkCuda(cudaGetLastError(), "launch of signal");
}

#else

void Gate::carryBefore(const Exec&, const Watch&, std::span<const Parcel> parcels) { ParcelWords(parcels).onHost(); }
void Gate::pass(const Exec&, const Watch&, std::span<const Parcel> parcels) { ParcelWords(parcels).onHost(); }
void Gate::signal(const Exec&, Mark, std::span<const Parcel> parcels) { ParcelWords(parcels).onHost(); }

#endif

const std::uint32_t* Gate::calledOff() const { return passed_.empty() ? nullptr : &passed_.data()->off; }

void Gate::open() {
  if (exec_.onCpu()) return;
  std::atomic_ref(words_.host()[0].value).store(++opened_, std::memory_order_release);
}

void Gate::await(Mark mark) {
  if (exec_.onCpu()) return;
  const auto signalled = [this, mark] {
    return std::atomic_ref(words_.host()[1 + mark].value).load(std::memory_order_acquire) >= opened_;
  };
  constexpr int kSpins = 1 << 16; // between two queries of the device state
  while (!signalled()) {
    for (int k = 0; k < kSpins && !signalled(); ++k) {
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
    if (!signalled() && !isBusy(exec_) && !signalled())
      throw std::logic_error("a run passed the gate without reporting");
  }
}

void Gate::callOff() {
  if (exec_.onCpu()) return;
  std::atomic_ref(words_.host()[0].value).store(kCalledOff, std::memory_order_release);
  synchronize(exec_);
  passed_.zero();
  synchronize(exec_);
  for (std::size_t k = 0; k < words_.size(); ++k) words_.host()[k].value = 0;
  opened_ = 0;
}

} // namespace grouser::base

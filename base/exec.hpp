// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace grouser::base {

enum class Device { Cpu, Cuda };

/// Execution target: CPU threads, or a stream of a CUDA device. Cheap to copy and non-owning: the stream that
/// cudaExec() creates exists until the program ends.
struct Exec {
  Device device{Device::Cpu};
  int threads{1};        ///< CPU threads, >= 1
  void* stream{nullptr}; ///< cudaStream_t if device is Cuda

  bool onCpu() const { return device == Device::Cpu; }
};

/// Returns an Exec for the CPU. `threads` = 0 uses all cores available to this process.
Exec cpuExec(int threads = 0);
/// Returns an Exec for CUDA device `index`. Throws DeviceError if this build or machine has no CUDA device.
Exec cudaExec(int index = 0);
/// True if this build supports CUDA and a usable device is present.
bool cudaAvailable();
/// Number of multiprocessors of the device; 0 for a CPU.
int multiprocessors(const Exec& exec);
/// Number of usable CUDA devices of this machine; may be 0.
int cudaDevices();
/// Identity of the GPU within the machine, independent of its index in this process; 0 for a CPU.
std::uint64_t deviceId(const Exec& exec);
/// One-line description of the device: processor name and cores, or GPU name and memory.
std::string describe(const Exec& exec);
/// Device memory in use by all programs [B]; for a CPU the peak of this process.
std::size_t usedMemory(const Exec& exec);

/// Waits until all work queued on `exec` has finished. Throws DeviceError with the returned code.
void synchronize(const Exec& exec);
/// True if work queued on `exec` has not finished; does not wait. Throws DeviceError with the returned code.
bool isBusy(const Exec& exec);

/// Allocates zeroed memory on the device of `exec`. Throws DeviceError, with the bytes requested if out of memory.
void* allocate(const Exec& exec, std::size_t bytes);
/// Allocates uninitialised memory on the device of `exec`.
void* allocateUnset(const Exec& exec, std::size_t bytes);
/// Frees memory in stream order: work already queued on `exec`, and on side streams joined to it, may still use it.
void release(const Exec& exec, void* memory) noexcept;
/// Allocates uninitialised memory that other processes can map, as MPI does with device memory. The pool used by
/// allocate() cannot be shared with other processes.
void* allocateForMessages(const Exec& exec, std::size_t bytes);
/// Waits until the memory is no longer in use, then frees it.
void releaseForMessages(const Exec& exec, void* memory) noexcept;
void copyToDevice(const Exec& exec, void* device, const void* host, std::size_t bytes);
/// Waits for earlier work on the stream, then copies.
void copyToHost(const Exec& exec, void* host, const void* device, std::size_t bytes);
/// Allocates zeroed page-locked host memory for asynchronous copies to and from the device; ordinary memory on the CPU.
void* allocatePinned(const Exec& exec, std::size_t bytes);
void releasePinned(const Exec& exec, void* memory) noexcept;
/// Enqueues a copy on the stream without waiting; `host` must be pinned and must not change until the next
/// synchronize().
void copyToDeviceLater(const Exec& exec, void* device, const void* host, std::size_t bytes);
void copyToHostLater(const Exec& exec, void* host, const void* device, std::size_t bytes);
void copyOnDevice(const Exec& exec, void* to, const void* from, std::size_t bytes);
void setZero(const Exec& exec, void* device, std::size_t bytes);

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace grouser::base {

enum class Device { Cpu, Cuda };

/// Execution target: CPU threads, or one CUDA device and its stream. Cheap to copy; owns nothing: the stream that
/// cudaExec() makes lives as long as the program.
struct Exec {
  Device device{Device::Cpu};
  int threads{1};        ///< CPU threads, >= 1
  void* stream{nullptr}; ///< cudaStream_t where device is Cuda

  bool onCpu() const { return device == Device::Cpu; }
};

/// Execution on the CPU. `threads` 0 uses all cores available to this process.
Exec cpuExec(int threads = 0);
/// Execution on CUDA device `index`. Throws DeviceError where this build or machine has none.
Exec cudaExec(int index = 0);
/// True where this build has CUDA and a usable device is present.
bool cudaAvailable();
/// Multiprocessors of its device; 0 on a CPU.
int multiprocessors(const Exec& exec);
/// Usable CUDA devices of this machine; 0 where there are none.
int cudaDevices();
/// Identity of the GPU within the machine, independent of its index in this process; 0 on the CPU.
std::uint64_t deviceId(const Exec& exec);
/// One line about the device: cores and processor, or the GPU's name and memory.
std::string describe(const Exec& exec);
/// Memory in use on the device by all programs [B]; on the CPU the peak of this process.
std::size_t memoryTaken(const Exec& exec);

/// Waits until all work queued on `exec` has ended. Throws DeviceError with the code received.
void synchronize(const Exec& exec);
/// True if work queued on `exec` has not ended yet; does not wait. Throws DeviceError with the code received.
bool isBusy(const Exec& exec);

/// Untyped memory on `exec`'s device, zeroed. Throws DeviceError (out of memory names the bytes requested).
void* allocate(const Exec& exec, std::size_t bytes);
/// The same, not zeroed.
void* allocateUnset(const Exec& exec, std::size_t bytes);
/// Frees memory in stream order: work queued on `exec` so far, and on side streams joined to it, may still use it.
void release(const Exec& exec, void* memory) noexcept;
/// Memory that other processes can map, as MPI does with device memory; not zeroed. Memory of allocate() comes from a
/// pool that no other process can open.
void* allocateForMessages(const Exec& exec, std::size_t bytes);
/// Waits until nothing uses the memory.
void releaseForMessages(const Exec& exec, void* memory) noexcept;
void copyToDevice(const Exec& exec, void* device, const void* host, std::size_t bytes);
/// Waits for earlier work on the stream, then copies.
void copyToHost(const Exec& exec, void* host, const void* device, std::size_t bytes);
/// Page-locked host memory that the device copies to and from without waiting; ordinary memory on the CPU. Zeroed.
void* allocatePinned(const Exec& exec, std::size_t bytes);
void releasePinned(const Exec& exec, void* memory) noexcept;
/// Copies in the order of the stream, without waiting; `host` is pinned and stays untouched until the next
/// synchronize().
void copyToDeviceLater(const Exec& exec, void* device, const void* host, std::size_t bytes);
void copyToHostLater(const Exec& exec, void* host, const void* device, std::size_t bytes);
void copyOnDevice(const Exec& exec, void* to, const void* from, std::size_t bytes);
void setZero(const Exec& exec, void* device, std::size_t bytes);

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/enum_words.hpp"
#include "base/exec.hpp"

#include <string>

namespace grouser::support {

enum class DeviceChoice {
  automatic, ///< GPU if available
  cpu,
  cuda
};

/// The device that a value of --device names. Throws InputError if the value is unknown.
DeviceChoice deviceChoice(const std::string& word);

/// Environment variable with the first GPU that a process uses, as an index from 0 among the GPUs visible to CUDA
/// (CUDA_VISIBLE_DEVICES, ordered by CUDA_DEVICE_ORDER).
constexpr const char* kFirstGpu = "GROUSER_GPU";

/// Index of the GPU, out of `gpus` (> 0), for a rank of this host: (value of kFirstGpu or 0, + `rankOnHost`) modulo
/// `gpus`. Throws InputError for an invalid value of the variable.
int gpuOf(int rankOnHost, int gpus);

/// Value of kFirstGpu for concurrent child process number `place`, counted from 0: children use the GPUs in turn,
/// starting with the GPU of this process. Throws like gpuOf().
std::string firstGpuOf(int place);

/// Device of a run; `threads` 0: base::cpuThreads(), or threadsOfRank(). Ranks of one host use its GPUs in turn. Throws
/// DeviceError if the device is missing. All ranks must call it.
base::Exec chooseDevice(DeviceChoice device, int threads, const base::Ranks* ranks);

/// Default number of threads of this rank: ranks of a host share its CPU quota and the cores that several of them may
/// use; a core bound to one rank belongs to this rank alone. All ranks must call it.
int threadsOfRank(const base::Comm& comm);

} // namespace grouser::support

template <> struct grouser::base::EnumWords<grouser::support::DeviceChoice> {
  using E = support::DeviceChoice;
  static constexpr EnumWord<E> list[] = {{E::automatic, "auto"}, {E::cpu, "cpu"}, {E::cuda, "cuda"}};
};

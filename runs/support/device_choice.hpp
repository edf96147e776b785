// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/enum_words.hpp"
#include "base/exec.hpp"

#include <string>

namespace grouser::support {

enum class DeviceChoice {
  automatic, ///< the GPU where there is one
  cpu,
  cuda
};

/// Of the word of --device. Throws InputError for one that is none.
DeviceChoice deviceChoice(const std::string& word);

/// Names the GPU of this machine that a process begins with, counted from 0 among those that CUDA sees
/// (CUDA_VISIBLE_DEVICES, in the order of CUDA_DEVICE_ORDER): a variable of the environment.
constexpr const char* kFirstGpu = "GROUSER_GPU";

/// The one of `gpus` (> 0) that a rank of this host takes: the first that kFirstGpu names, 0 where it names none, and
/// so many further on, in turn. Throws InputError where the variable is no such number.
int gpuOf(int rankOnHost, int gpus);

/// What kFirstGpu is to say in the process at that place, from 0 on, of those that a call has at work at the same time:
/// they take the GPUs in turn, from this process's own on. Throws as gpuOf().
std::string firstGpuOf(int place);

/// Where to compute; `threads` 0 takes all cores. Ranks of one host take its GPUs in turn and share its cores. Throws
/// DeviceError where there is no such device.
base::Exec chooseDevice(DeviceChoice device, int threads, const base::Ranks* ranks);

} // namespace grouser::support

template <> struct grouser::base::EnumWords<grouser::support::DeviceChoice> {
  using E = support::DeviceChoice;
  static constexpr EnumWord<E> list[] = {{E::automatic, "auto"}, {E::cpu, "cpu"}, {E::cuda, "cuda"}};
};

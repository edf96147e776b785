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

/// Where to compute; `threads` 0 takes all cores. Ranks of one host take its GPUs in turn and share its cores. Throws
/// DeviceError where there is no such device.
base::Exec chooseDevice(DeviceChoice device, int threads, const base::Ranks* ranks);

} // namespace grouser::support

template <> struct grouser::base::EnumWords<grouser::support::DeviceChoice> {
  using E = support::DeviceChoice;
  static constexpr EnumWord<E> list[] = {{E::automatic, "auto"}, {E::cpu, "cpu"}, {E::cuda, "cuda"}};
};

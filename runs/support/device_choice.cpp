// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/device_choice.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::support {

DeviceChoice deviceChoice(const std::string& word) {
  if (const auto choice = base::valueOf<DeviceChoice>(word)) return *choice;
  throw base::InputError(
      fmt::format("--device {}: is none of {}", word, fmt::join(base::wordsOf<DeviceChoice>(), ", ")));
}

base::Exec chooseDevice(DeviceChoice device, int threads, const base::Ranks* ranks) {
  if (device == DeviceChoice::cuda || (device == DeviceChoice::automatic && base::cudaAvailable()))
    return base::cudaExec(ranks ? ranks->rankOnHost() % std::max(1, base::cudaDevices()) : 0);
  if (threads == 0 && ranks && ranks->ranksOnHost() > 1)
    threads = std::max(1, base::cpuExec().threads / ranks->ranksOnHost());
  return base::cpuExec(threads);
}

} // namespace grouser::support

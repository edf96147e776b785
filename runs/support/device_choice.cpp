// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/device_choice.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::support {

base::Exec chooseDevice(const std::string& device, int threads, const base::Ranks* ranks) {
  if (device != "auto" && device != "cpu" && device != "cuda")
    throw base::InputError(fmt::format("--device {}: is none of auto, cpu, cuda", device));
  if (device == "cuda" || (device == "auto" && base::cudaAvailable()))
    return base::cudaExec(ranks ? ranks->rankOnHost() % std::max(1, base::cudaDevices()) : 0);
  if (threads == 0 && ranks && ranks->ranksOnHost() > 1)
    threads = std::max(1, base::cpuExec().threads / ranks->ranksOnHost());
  return base::cpuExec(threads);
}

} // namespace grouser::support

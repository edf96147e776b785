// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/device_choice.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace grouser::support {

namespace {

constexpr int kMaxGpus = 1 << 20; ///< far more than any machine has; sums do not overflow an int

/// Value of kFirstGpu; 0 if it is unset or empty.
int firstGpu() {
  const char* given = std::getenv(kFirstGpu);
  if (!given || !*given) return 0;
  const std::string_view text = given;
  int first = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), first);
  if (error != std::errc() || end != text.data() + text.size() || first < 0 || first > kMaxGpus)
    throw base::InputError(
        fmt::format("{} = '{}' must be the index of a visible CUDA device, from 0 to {}; correct or unset it",
                    kFirstGpu, text, kMaxGpus));
  return first;
}

} // namespace

int gpuOf(int rankOnHost, int gpus) { return (firstGpu() % gpus + rankOnHost) % gpus; }

std::string firstGpuOf(int place) { return std::to_string(firstGpu() + place); }

DeviceChoice deviceChoice(const std::string& word) {
  if (const auto choice = base::valueOf<DeviceChoice>(word)) return *choice;
  throw base::InputError(
      fmt::format("--device {}: must be one of {}", word, fmt::join(base::wordsOf<DeviceChoice>(), ", ")));
}

base::Exec chooseDevice(DeviceChoice device, int threads, const base::Ranks* ranks) {
  if (device == DeviceChoice::cuda || (device == DeviceChoice::automatic && base::cudaAvailable()))
    return base::cudaExec(gpuOf(ranks ? ranks->rankOnHost() : 0, std::max(1, base::cudaDevices())));
  if (threads == 0 && ranks && ranks->ranksOnHost() > 1)
    threads = std::max(1, base::cpuExec().threads / ranks->ranksOnHost());
  return base::cpuExec(threads);
}

} // namespace grouser::support

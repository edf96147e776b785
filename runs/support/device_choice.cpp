// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/device_choice.hpp"

#include "base/cpu_threads.hpp"
#include "base/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

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
  // Ranks exchange their cores before they choose, since hosts may differ in their devices.
  if (threads == 0 && ranks && !ranks->comm().alone()) threads = threadsOfRank(ranks->comm());
  if (device == DeviceChoice::cuda || (device == DeviceChoice::automatic && base::cudaAvailable()))
    return base::cudaExec(gpuOf(ranks ? ranks->rankOnHost() : 0, std::max(1, base::cudaDevices())));
  return base::cpuExec(threads);
}

int threadsOfRank(const base::Comm& comm) {
  if (comm.alone()) return base::cpuThreads().count;
  base::ompNumThreads(); // rejects an invalid value
  base::ThreadLimits limits = base::threadLimits();
  const std::vector<std::uint64_t> mine = base::affinityMask();
  const std::vector<std::vector<std::uint64_t>> masks = comm.gatherAll(mine);
  std::vector<std::vector<std::uint64_t>> ofHost;
  for (int r = 0; r < comm.size(); ++r)
    if (comm.hostOf(r) == comm.hostOf(comm.rank())) ofHost.push_back(masks[static_cast<std::size_t>(r)]);
  // OMP_PROC_BIND binds the calling thread alone; its mask then says nothing about the cores of the process.
  limits.affinity = base::coresIn(mine) == limits.affinity
                        ? base::shareOfCores(mine, ofHost)
                        : std::max(1, limits.affinity / static_cast<int>(ofHost.size()));
  return base::lowestLimit(limits, static_cast<int>(ofHost.size())).count;
}

} // namespace grouser::support

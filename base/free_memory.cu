// SPDX-License-Identifier: BSD-3-Clause
#include "base/free_memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

#if defined(__CUDACC__)
#include <cuda_runtime.h>
#endif

namespace grouser::base {

namespace {

void lower(std::optional<double>& room, double to) { room = std::max(0.0, room ? std::min(*room, to) : to); }

/// Reads a number from a file; empty if the content is not a number ("max").
std::optional<double> numberIn(const std::string& file) {
  std::ifstream in(file);
  double value = 0;
  return in >> value ? std::optional(value) : std::nullopt;
}

} // namespace

std::optional<double> freeMemoryOfHost() {
  std::optional<double> room;
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;) {
    double kib = 0;
    if (word == "MemAvailable:" && info >> kib) lower(room, 1024 * kib);
  }
  const auto most = numberIn("/sys/fs/cgroup/memory.max"), now = numberIn("/sys/fs/cgroup/memory.current");
  if (most && now) {
    double files = 0; // cached file pages, which can be reclaimed
    std::ifstream parts("/sys/fs/cgroup/memory.stat");
    for (std::string word; parts >> word;)
      if (word == "file") parts >> files;
    lower(room, *most - (*now - files));
  }
  rlimit limit{};
  long pages = 0;
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      std::ifstream("/proc/self/statm") >> pages)
    lower(room, static_cast<double>(limit.rlim_cur) -
                    static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)));
  return room;
}

std::optional<double> freeMemoryOf(const Exec& exec) {
  if (exec.onCpu()) return freeMemoryOfHost();
#if defined(__CUDACC__)
  std::size_t unused = 0, total = 0;
  if (cudaMemGetInfo(&unused, &total) == cudaSuccess) return static_cast<double>(unused);
#endif
  return {};
}

} // namespace grouser::base

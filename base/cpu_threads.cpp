// SPDX-License-Identifier: BSD-3-Clause
#include "base/cpu_threads.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <omp.h>
#include <sched.h>
#include <sstream>
#include <string_view>
#include <sys/sysinfo.h>

namespace grouser::base {

namespace {

/// Keeps an invalid OMP_NUM_THREADS for error messages.
constexpr const char* kHiddenVariable = "GROUSER_INVALID_OMP_NUM_THREADS";

constexpr std::size_t kMaxCores = 8192; ///< as in the kernel's largest configuration

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Quota of one cgroup [cores]; empty without one.
std::optional<double> quotaOf(const std::filesystem::path& group) {
  double quota = 0, period = 0;
  // Version 2: "150000 100000" or "max 100000".
  if (std::istringstream two(textOf(group / "cpu.max")); two >> quota >> period && quota > 0 && period > 0)
    return quota / period;
  // Version 1: -1 without a quota.
  std::istringstream limit(textOf(group / "cpu.cfs_quota_us")), interval(textOf(group / "cpu.cfs_period_us"));
  if (limit >> quota && interval >> period && quota > 0 && period > 0) return quota / period;
  return {};
}

void lower(std::optional<double>& least, std::optional<double> value) {
  if (value && (!least || *value < *least)) least = value;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

} // namespace

std::optional<int> ompNumThreads() {
  const char* given = std::getenv("OMP_NUM_THREADS");
  if (const char* hidden = std::getenv(kHiddenVariable); hidden && !given) given = hidden;
  if (!given || trimmed(given).empty()) return {};
  std::optional<int> first;
  std::string_view rest = given;
  while (true) {
    const std::string_view word = trimmed(rest.substr(0, rest.find(',')));
    int count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || end != word.data() + word.size() || count < 1)
      throw InputError(
          fmt::format("OMP_NUM_THREADS = '{}' must be a number of threads, from 1 to {}, or a list such as "
                      "4,2; correct or unset it, or set --threads",
                      given, INT_MAX));
    if (!first) first = count;
    if (rest.find(',') == std::string_view::npos) return first;
    rest.remove_prefix(rest.find(',') + 1);
  }
}

void hideInvalidOmpNumThreads() {
  try {
    ompNumThreads();
  } catch (const InputError&) {
    const char* given = std::getenv("OMP_NUM_THREADS");
    if (!given) return;
    setenv(kHiddenVariable, given, 1);
    unsetenv("OMP_NUM_THREADS");
  }
}

std::optional<double> cpuQuota(const std::string& own, const std::filesystem::path& mount) {
  std::optional<double> least;
  std::istringstream lines(own); // e.g. "0::/user.slice" (version 2), "4:cpu,cpuacct:/job" (version 1)
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::filesystem::path path = std::filesystem::path(line.substr(second + 1)).relative_path();
    std::vector<std::filesystem::path> tops{mount / controllers, mount / "cpu"};
    if (controllers.empty())
      tops = {mount, mount / "unified"};
    else if (("," + controllers + ",").find(",cpu,") == std::string::npos)
      continue;
    for (const std::filesystem::path& top : tops) {
      // In a container, the path may be that of the host, and only the mounted folder exists.
      for (std::filesystem::path group = path; !group.empty(); group = group.parent_path())
        lower(least, quotaOf(top / group));
      lower(least, quotaOf(top));
    }
  }
  return least;
}

CpuThreads lowestLimit(const ThreadLimits& limits, int ranksInQuota) {
  CpuThreads t;
  t.machine = std::max(limits.machine, limits.affinity);
  t.count = t.cores = std::max(1, limits.affinity);
  if (t.cores < t.machine) t.cause = "the CPU affinity of the process";
  const auto limit = [&t](int count, const std::string& cause) {
    if (count < t.count) t.count = std::max(1, count), t.cause = cause;
  };
  if (limits.quota) {
    limit(static_cast<int>(std::min(std::ceil(*limits.quota / ranksInQuota - 1e-9), 1e6)),
          fmt::format("a CPU quota of {:.3g} core{}", *limits.quota, *limits.quota == 1 ? "" : "s"));
    t.cores = t.count;
  }
  if (limits.ompNumThreads) limit(*limits.ompNumThreads, fmt::format("OMP_NUM_THREADS = {}", *limits.ompNumThreads));
  if (limits.ompThreadLimit)
    limit(*limits.ompThreadLimit, fmt::format("OMP_THREAD_LIMIT = {}", *limits.ompThreadLimit));
  return t;
}

ThreadLimits threadLimits() {
  ThreadLimits limits;
  limits.machine = get_nprocs();
  limits.affinity = omp_get_num_procs();
  limits.quota = cpuQuota(textOf("/proc/self/cgroup"), "/sys/fs/cgroup");
  try {
    limits.ompNumThreads = ompNumThreads();
  } catch (const InputError&) { // reported where the value is needed
  }
  if (const int limit = omp_get_thread_limit(); limit < INT_MAX) limits.ompThreadLimit = limit;
  return limits;
}

CpuThreads cpuThreads() {
  ompNumThreads();
  return lowestLimit(threadLimits());
}

std::vector<std::uint64_t> affinityMask() {
  std::vector<std::uint64_t> mask(kMaxCores / 64);
  cpu_set_t* const set = CPU_ALLOC(kMaxCores);
  const std::size_t bytes = CPU_ALLOC_SIZE(kMaxCores);
  if (sched_getaffinity(0, bytes, set) == 0)
    for (std::size_t i = 0; i < kMaxCores; ++i)
      if (CPU_ISSET_S(i, bytes, set)) mask[i / 64] |= std::uint64_t{1} << (i % 64);
  CPU_FREE(set);
  return mask;
}

int coresIn(const std::vector<std::uint64_t>& mask) {
  int count = 0;
  for (const std::uint64_t word : mask) count += std::popcount(word);
  return count;
}

void unbindFirstThread() {
  std::vector<int> cores;
  for (int place = 0; place < omp_get_num_places(); ++place) {
    std::vector<int> ids(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, ids.data());
    cores.insert(cores.end(), ids.begin(), ids.end());
  }
  if (cores.empty()) return; // not bound
  cpu_set_t* const set = CPU_ALLOC(kMaxCores);
  const std::size_t bytes = CPU_ALLOC_SIZE(kMaxCores);
  CPU_ZERO_S(bytes, set);
  for (const int core : cores) CPU_SET_S(static_cast<std::size_t>(core), bytes, set);
  sched_setaffinity(0, bytes, set);
  CPU_FREE(set);
}

int shareOfCores(const std::vector<std::uint64_t>& mine, const std::vector<std::vector<std::uint64_t>>& all) {
  double share = 0;
  for (std::size_t i = 0; i < 64 * mine.size(); ++i) {
    const auto has = [i](const std::vector<std::uint64_t>& mask) {
      return i / 64 < mask.size() && (mask[i / 64] >> (i % 64) & 1) != 0;
    };
    if (has(mine))
      share += 1.0 / static_cast<double>(std::max<std::ptrdiff_t>(1, std::count_if(all.begin(), all.end(), has)));
  }
  return std::max(1, static_cast<int>(share + 1e-9));
}

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Default number of CPU threads of a process: usable cores, CPU quota of its cgroups, OMP_NUM_THREADS and
/// OMP_THREAD_LIMIT. Results do not depend on the number of threads.
namespace grouser::base {

/// Default number of threads and its cause.
struct CpuThreads {
  int count{1};   ///< default number of threads, >= 1
  int cores{1};   ///< cores that the process may use at once: affinity and CPU quota (rounded up)
  int machine{1}; ///< cores of the machine
  std::string
      cause; ///< lowest limit, e.g. "a CPU quota of 1.5 cores"; empty if the default is all cores of the machine
};

/// Values that limit the number of threads; cpuThreads() reads them from this process.
struct ThreadLimits {
  int machine{1}, affinity{1}; ///< cores of the machine, cores that this process may use
  std::optional<double> quota; ///< [cores]
  std::optional<int> ompNumThreads, ompThreadLimit;
};

/// Lowest of the limits; `ranksInQuota`: number of processes that share the quota.
CpuThreads lowestLimit(const ThreadLimits& limits, int ranksInQuota = 1);

/// Throws InputError if OMP_NUM_THREADS is set but is not a list of positive integers.
CpuThreads cpuThreads();
/// The limits of this process. An invalid OMP_NUM_THREADS is ignored.
ThreadLimits threadLimits();

/// First number of OMP_NUM_THREADS, e.g. 4 for "4,2"; empty if unset or blank. Throws InputError for other values.
std::optional<int> ompNumThreads();
/// Moves an invalid OMP_NUM_THREADS to another variable, which ompNumThreads() reads, so that the OpenMP library of a
/// program that this process starts does not complain about it once more.
void hideInvalidOmpNumThreads();

/// Lowest CPU quota of the cgroups of a process and of their parents [cores]; empty without a quota. `own`: text of
/// /proc/self/cgroup; `mount`: folder with the cgroups (versions 1 and 2).
std::optional<double> cpuQuota(const std::string& own, const std::filesystem::path& mount);

/// Cores that this process may use, one bit each.
std::vector<std::uint64_t> affinityMask();
int coresIn(const std::vector<std::uint64_t>& mask);
/// OMP_PROC_BIND binds the first thread to one place. Lets this thread use all places again, for a program that it
/// starts.
void unbindFirstThread();
/// Share of `mine` if processes with equal bits share these cores; `all`: masks of all processes of the host, including
/// this one. At least 1.
int shareOfCores(const std::vector<std::uint64_t>& mine, const std::vector<std::vector<std::uint64_t>>& all);

} // namespace grouser::base

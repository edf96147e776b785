// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/build_info.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"
#include "grouser_commit.hpp"
#include "runs/support/locations.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

namespace grouser::support {

namespace {

std::string compilerText() {
#if defined(__clang__)
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

std::string processorText() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

} // namespace

BuildInfo buildInfo() { return {GROUSER_VERSION, kCommit, compilerText(), GROUSER_CUDA_VERSION, GROUSER_FLAGS}; }

/// Reads words of eight bytes; a program file of 100 MB takes 0.05 s.
std::string programHash() {
  static const std::string hash = [] {
    const std::string own = ownFile().string();
    std::ifstream file(own, std::ios::binary);
    if (!file) throw base::InputError(own + ": the program's own file cannot be read; check its permissions");
    base::StateHash h;
    std::vector<char> chunk(1 << 20);
    while (file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), file.gcount() > 0) {
      const auto got = static_cast<std::size_t>(file.gcount());
      for (std::size_t i = 0; i < got; i += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, chunk.data() + i, std::min(sizeof word, got - i));
        h.add(word);
      }
    }
    return h.hex();
  }();
  return hash;
}

std::string versionText() {
  const BuildInfo b = buildInfo();
  return fmt::format("grouser {}\ncommit {}\ncompiler {}\nflags {}\nCUDA {}", b.version, b.commit, b.compiler, b.flags,
                     b.cuda.empty() ? "not built in" : b.cuda);
}

std::string machineText() {
  utsname system{};
  uname(&system);
  const double gib = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) /
                     (1024.0 * 1024 * 1024);
  return fmt::format("{}, {} logical cores, {:.0f} GiB, {} {}", processorText(), sysconf(_SC_NPROCESSORS_ONLN), gib,
                     system.sysname, system.release);
}

std::string slurmJob() {
  const char *cluster = std::getenv("SLURM_CLUSTER_NAME"), *job = std::getenv("SLURM_JOB_ID");
  if (!job || !*job) return "";
  return cluster && *cluster ? fmt::format("{} {}", cluster, job) : job;
}

} // namespace grouser::support

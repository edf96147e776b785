// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::support {

/// Version, commit, compiler and options of this program.
struct BuildInfo {
  std::string version;  ///< "0.1.0"
  std::string commit;   ///< short hash, with "-dirty" if the sources were changed; "unknown" outside git
  std::string compiler; ///< "GCC 12.2.0"
  std::string cuda;     ///< toolkit version; empty if built without CUDA
  std::string flags;    ///< "Release -O3 -DNDEBUG ...": build type and compiler options
};
BuildInfo buildInfo();

/// Hash of the file of the running program, since version and commit do not reflect uncommitted changes and the
/// compiler. Throws InputError if the file cannot be read.
std::string programHash();

/// Text of `grouser --version`.
std::string versionText();

/// Description of this machine: processor, logical cores, memory, system.
std::string machineText();

/// SLURM job that started this program, after the name of its cluster if there is one: "tetralith 4711"; empty without
/// SLURM. A requeued job keeps its number.
std::string slurmJob();

} // namespace grouser::support

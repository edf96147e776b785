// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::support {

/// Version, commit, compiler and options of this program.
struct BuildInfo {
  std::string version;  ///< "0.1.0"
  std::string commit;   ///< short hash, "-dirty" behind it where the sources were changed; "unknown" outside git
  std::string compiler; ///< "GCC 12.2.0"
  std::string cuda;     ///< toolkit version; empty where built without
  std::string flags;    ///< "Release -O3 -DNDEBUG ...": build type and options of the compiler
};
BuildInfo buildInfo();

/// Hash of the file of the running program: a version or commit does not show uncommitted changes or the compiler.
/// Throws InputError where the file cannot be read.
std::string programHash();

/// `grouser --version`: one line a fact.
std::string versionText();

/// The machine this runs on: processor, logical cores, memory, system.
std::string machineText();

} // namespace grouser::support

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

namespace grouser {

/// Device of the tests: `threads` CPU threads, or CUDA (ranks use its devices in turn) if the
/// environment variable GROUSER_TEST_DEVICE is cuda (tests/gpu sets it). Expected results are the same.
inline base::Exec testExec(int threads = 1, int rank = 0) {
  const char* device = std::getenv("GROUSER_TEST_DEVICE");
  if (!device || std::string(device) != "cuda") return base::cpuExec(threads);
  return base::cudaExec(rank % std::max(1, base::cudaDevices()));
}

#ifdef GROUSER_SOURCE_DIR
/// Source folder; GROUSER_TEST_SOURCE overrides it if the sources moved after the build.
inline std::string sourceFolder() {
  const char* moved = std::getenv("GROUSER_TEST_SOURCE");
  return moved ? moved : GROUSER_SOURCE_DIR;
}
/// A scene of tests/scenes.
inline std::string testScene(const std::string& name) { return sourceFolder() + "/tests/scenes/" + name; }
#endif

} // namespace grouser

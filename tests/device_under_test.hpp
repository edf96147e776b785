// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

namespace grouser {

/// Where the tests that take it compute: on `threads` CPU threads, or on CUDA (ranks take its devices in turn) where
/// the environment says GROUSER_TEST_DEVICE=cuda (tests/gpu sets it). The claims are the same on both.
inline base::Exec testExec(int threads = 1, int rank = 0) {
  const char* device = std::getenv("GROUSER_TEST_DEVICE");
  if (!device || std::string(device) != "cuda") return base::cpuExec(threads);
  return base::cudaExec(rank % std::max(1, base::cudaDevices()));
}

#ifdef GROUSER_SOURCE_DIR
/// Of the sources, which GROUSER_TEST_SOURCE names where they have moved since the build.
inline std::string sourceFolder() {
  const char* moved = std::getenv("GROUSER_TEST_SOURCE");
  return moved ? moved : GROUSER_SOURCE_DIR;
}
/// A scene of tests/scenes.
inline std::string testScene(const std::string& name) { return sourceFolder() + "/tests/scenes/" + name; }
#endif

} // namespace grouser

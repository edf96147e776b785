// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/storage/bed_cache.hpp"
#include "runs/storage/sphere_cache.hpp"

#include <cstdlib>
#include <optional>
#include <string>

namespace grouser {

/// Cache folder shared by the tests of one ctest call for sphere sets and settled beds; without it each test prepares
/// its own. ctest starts with an empty folder (tests/CMakeLists.txt), so that it holds no data of another build.
inline std::string sharedCache() {
  const char* folder = std::getenv("GROUSER_TEST_CACHE");
  return folder ? folder : "";
}

template <typename Cache> Cache* inSharedCache() {
  static std::optional<Cache> kept =
      sharedCache().empty() ? std::nullopt : std::optional<Cache>(support::KeptFiles(sharedCache()));
  return kept ? &*kept : nullptr;
}

/// For simulations in tests not about converting parts or settling beds; null without a shared folder. Cached data
/// are bitwise equal to new ones (KeptSpheres.*, KeptBeds.*, and the hashes of OneAnswer.*).
inline storage::SphereCache* sharedSpheres() { return inSharedCache<storage::SphereCache>(); }
inline storage::BedCache* sharedBeds() { return inSharedCache<storage::BedCache>(); }

/// Use before a call of the program whose preparation is not under test.
inline std::string withSharedCache() { return "export GROUSER_CACHE='" + sharedCache() + "'; "; }

} // namespace grouser

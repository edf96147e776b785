// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/storage/bed_cache.hpp"
#include "runs/storage/sphere_cache.hpp"

#include <cstdlib>
#include <optional>
#include <string>

namespace grouser {

/// The folder in which the tests of one call of ctest share what they have cut and settled, or none: then each prepares
/// all by itself. ctest begins with an empty one (tests/CMakeLists.txt), so that nothing is of another build.
inline std::string sharedCache() {
  const char* folder = std::getenv("GROUSER_TEST_CACHE");
  return folder ? folder : "";
}

template <typename Cache> Cache* inSharedCache() {
  static std::optional<Cache> kept =
      sharedCache().empty() ? std::nullopt : std::optional<Cache>(support::KeptFiles(sharedCache()));
  return kept ? &*kept : nullptr;
}

/// For simulations whose test is not about cutting parts, or settling beds; null where nothing is shared. What is taken
/// has the bits of what would be cut or settled (KeptSpheres.*, KeptBeds.*, and the hashes of OneAnswer.*).
inline storage::SphereCache* sharedSpheres() { return inSharedCache<storage::SphereCache>(); }
inline storage::BedCache* sharedBeds() { return inSharedCache<storage::BedCache>(); }

/// Before a call of the program whose preparation is none of the test's claims.
inline std::string withSharedCache() { return "export GROUSER_CACHE='" + sharedCache() + "'; "; }

} // namespace grouser

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/simulation/sphere_cache.hpp"

#include <cstdlib>
#include <optional>
#include <string>

namespace grouser {

/// The folder in which the tests of one call of ctest share the parts that they have cut, or none: then each cuts for
/// itself. ctest begins with an empty one (tests/CMakeLists.txt), so that no part is of another build.
inline std::string sharedSpheres() {
  const char* folder = std::getenv("GROUSER_TEST_SPHERES");
  return folder ? folder : "";
}

/// For simulations of vehicles whose test is not about the cutting; null where nothing is shared. The sets are those of
/// the cut, bit for bit (KeptSpheres.*).
inline simulation::SphereCache* keptSpheres() {
  static std::optional<simulation::SphereCache> kept =
      sharedSpheres().empty() ? std::nullopt
                              : std::optional(simulation::SphereCache(support::KeptFiles(sharedSpheres())));
  return kept ? &*kept : nullptr;
}

/// Before a call of the program on rigid ground, where no bed is that could be kept as well.
inline std::string withKeptSpheres() { return "export GROUSER_CACHE='" + sharedSpheres() + "'; "; }

} // namespace grouser

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene.hpp"

#include <string>

namespace grouser::runs {

/// Reads and checks [[plane]], [[box]] and [[cylinder]]; their materials are the caller's affair. Throws InputError.
void readSurfaces(const base::Section& root, Scene& scene);
/// The same sections as TOML.
std::string surfacesToml(const Scene& scene);

} // namespace grouser::runs

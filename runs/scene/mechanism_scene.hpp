// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"

#include <string>

namespace grouser::scene {

/// Reads [[body]], [[joint]], [[spring]] and [[drive]] into `scene`, and checks that they make a mechanism: every
/// error names file, line, key, value and remedy.
void readMechanism(const base::Section& root, Scene& scene);

/// Throws where output.record names nothing of the mechanism.
void checkRecord(const base::Section& output, const Scene& scene);

/// The same sections as TOML.
std::string mechanismToml(const MechanismSections& mechanism);

} // namespace grouser::scene

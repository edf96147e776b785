// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"

#include <string>
#include <vector>

namespace grouser::setup {

/// Warning or note on a valid scene.
struct Notice {
  enum class Weight { warning, note } weight;
  std::string text;
};
std::vector<Notice> noticesOf(const scene::Scene& scene, const coupling::Simulation& simulation);

} // namespace grouser::setup

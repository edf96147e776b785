// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/scene/choices.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// One scene on several kinds of ground, or with several contact methods.
namespace grouser::sweeps {

/// Overrides that put a scene on this kind of ground: `sets` and terrain.kind, without the keys that only other kinds
/// have. Those in the file are removed ("~terrain.depth"). Throws InputError, with the key and the --set that is
/// missing, if the scene has no [terrain] or lacks what the ground needs.
std::vector<std::string> groundOverrides(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                                         scene::TerrainKind ground);

/// The same for a sweep, whose lists may contain required keys; the lists are excluded from the result.
std::vector<std::string> groundOverrides(const std::filesystem::path& scene, const SweepLists& lists,
                                         const std::vector<std::string>& fixed, scene::TerrainKind ground);

/// Overrides under which a scene has this contact method: `sets` and run.contact, without the keys that only the other
/// method has. A method other than the scene's takes its automatic step, unless `sets` give one.
std::vector<std::string> contactOverrides(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                                          scene::ContactMethod method);

} // namespace grouser::sweeps

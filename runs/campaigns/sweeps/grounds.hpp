// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/sweep_plan.hpp"
#include "runs/scene/choices.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// One scene on several kinds of ground, or with several contact methods.
namespace grouser::sweeps {

/// Overrides that select this kind of ground: `sets` and terrain.kind, without keys that only other kinds of ground
/// have. Such keys in the scene file are removed ("~terrain.depth"). Throws InputError, with the missing key and --set,
/// if the scene has no [terrain] or lacks keys that this kind of ground requires.
std::vector<std::string> groundOverrides(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                                         scene::TerrainKind ground);

/// The same for a sweep: its lists of values may contain required keys. The result excludes these lists.
std::vector<std::string> groundOverrides(const std::filesystem::path& scene, const SweepLists& lists,
                                         const std::vector<std::string>& fixed, scene::TerrainKind ground);

/// Overrides that select this contact method: `sets` and run.contact, without keys that only the other method has. If
/// the method differs from that of the scene, the time step is automatic, unless `sets` contain one.
std::vector<std::string> contactOverrides(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                                          scene::ContactMethod method);

} // namespace grouser::sweeps

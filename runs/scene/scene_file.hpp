// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Scenes as files: reading, the copy with all defaults, and the help on all keys.
namespace grouser::scene {

/// Reads a scene and checks what its keys say by themselves; loadScene() checks what they mean together, too.
/// Throws base::InputError with file, line, key, value, range and remedy.
Scene readScene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same from text; paths in it are relative to the folder of `file`.
Scene readSceneText(std::string_view text, const std::filesystem::path& file,
                    const std::vector<std::string>& overrides = {});

/// What becomes of a bed that is rained and not settled; empty where there is none, or nothing depends on it.
std::string unsettledWarning(const Scene& scene);

/// Says on stderr, a line each, which keys of the scene's file have a new name, and what is wrong only perhaps.
void printNotes(const Scene& scene);

/// The scene with every default filled in, as TOML that loads to the same scene.
std::string resolvedToml(const Scene& scene);

/// All keys of a scene file with unit, default, range and meaning, as Markdown.
std::string fieldHelp();

} // namespace grouser::scene

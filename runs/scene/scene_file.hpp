// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/scene/scene.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Scenes as files: reading, the copy with all defaults, and the help on all keys.
namespace grouser::scene {

/// Reads a scene and checks each section; loadScene() also checks their combinations. Throws base::InputError with
/// file, line, key, value, range and remedy.
Scene readScene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same from text; paths in it are relative to the folder of `file`.
Scene readSceneText(std::string_view text, const std::filesystem::path& file,
                    const std::vector<std::string>& overrides = {});

/// Warning about a random bed that does not settle; empty if there is none, or if nothing depends on the settled bed.
std::string unsettledWarning(const Scene& scene);

/// Notes on values outside the usual span of their key, which suggest another unit: in the scene, its soil files and
/// its vehicle file. Throws InputError for an invalid vehicle file.
std::vector<std::string> unusualValues(const Scene& scene);

/// Calls `act` and appends to its InputErrors the notes on unusual values of the keys that the error names: a value in
/// a wrong unit can make another key invalid.
void withUnusualValues(const Scene& scene, const std::function<void()>& act);

/// Warnings and notes on a scene, e.g. about renamed keys.
struct SceneNote {
  bool isWarning;
  std::string text;
};
std::vector<SceneNote> sceneNotes(const Scene& scene);
/// Prints them to stderr, one per line.
void printNotes(const Scene& scene);

/// The scene with every default filled in, as TOML that loads to the same scene.
std::string resolvedToml(const Scene& scene);

/// All keys of a scene file with unit, default, range and meaning, as Markdown.
std::string fieldHelp();

} // namespace grouser::scene

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::support {

/// The folder with assets/ and runs/plots/, the first of: GROUSER_SHARE of the environment; ../share/grouser relative
/// to the program, or share/grouser near the shared module of this code; folder of the installed library; the source
/// folder; /usr/local/share/grouser or /usr/share/grouser.
std::filesystem::path shareFolder();
/// Throws base::InputError if the environment variable GROUSER_SHARE is set, but not to a folder.
void requireShareFolder();
/// Sets the share folder of the installed library that the program links.
void setInstalledShare(const char* folder);
/// File of this code: a shared module (.so), or "/proc/self/exe" for a program.
std::filesystem::path ownFile();

/// Search folders for files of a scene: the scene's folder, the current folder, assets/.
std::vector<std::filesystem::path> inputFolders(const std::filesystem::path& scene);

/// The file that a scene refers to by `name`: an absolute path, or a path relative to the folder of `scene`, the
/// current folder or assets/. Empty if not found; `tried` then lists the searched paths (no paths for an empty name).
/// Throws base::InputError if only a folder, FIFO, device or the like has this name.
std::filesystem::path findInput(const std::string& name, const std::filesystem::path& scene,
                                std::vector<std::filesystem::path>& tried);

/// Hint for a missing file: "did you mean FILE? ", with the file of the same or the most similar name in its own folder
/// or in one of `folders`. Empty if no name is similar.
std::string nearestFileHint(const std::filesystem::path& wanted, const std::vector<std::filesystem::path>& folders);

} // namespace grouser::support

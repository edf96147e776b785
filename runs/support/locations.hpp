// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grouser::support {

/// The folder that holds assets/ and runs/plots/: GROUSER_SHARE of the environment if set, else beside the program
/// (../share/grouser) or beside the shared module of this code, else that of the installed library, else the source
/// folder that the program was built from, else, where that is gone, /usr/local/share/grouser or /usr/share/grouser.
std::filesystem::path shareFolder();
/// Sets the share folder of the installed library that the program links.
void setInstalledShare(const char* folder);
/// File of this code: a shared module (.so), or "/proc/self/exe" for a program.
std::filesystem::path ownFile();

/// Search folders of a scene's files: its own, the current one, assets/.
std::vector<std::filesystem::path> inputFolders(const std::filesystem::path& scene);

/// The file that a scene means by `name`: an absolute path, or relative to one of the folder of `scene`, the current
/// folder, assets/. Empty where there is none; `tried` then lists the places looked at, each once; none for an empty
/// name.
std::filesystem::path findInput(const std::string& name, const std::filesystem::path& scene,
                                std::vector<std::filesystem::path>& tried);

/// Hint for a missing file: "did you mean FILE? ", the file of the same name, or of the most similar one, in its
/// own folder or in one of `folders`. Empty where none is similar.
std::string nearestFileHint(const std::filesystem::path& wanted, const std::vector<std::filesystem::path>& folders);

} // namespace grouser::support

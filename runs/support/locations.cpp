// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/locations.hpp"

#include <algorithm>
#include <cstdlib>
#include <system_error>

namespace grouser::support {

namespace fs = std::filesystem;

fs::path shareFolder() {
  if (const char* set = std::getenv("GROUSER_SHARE"); set && *set) return set;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    fs::path beside = program.parent_path().parent_path() / "share" / "grouser";
    if (fs::is_directory(beside, error)) return beside;
  }
  // A program of one's own, built against an installed library, lies anywhere.
  for (const char* installed : {"/usr/local/share/grouser", "/usr/share/grouser"})
    if (!fs::is_directory(GROUSER_SHARE_FOLDER, error) && fs::is_directory(installed, error)) return installed;
  return GROUSER_SHARE_FOLDER;
}

std::vector<fs::path> inputFolders(const fs::path& scene) {
  std::error_code error;
  return {fs::absolute(scene, error).parent_path(), fs::current_path(error), shareFolder() / "assets"};
}

fs::path findInput(const std::string& name, const fs::path& scene, std::vector<fs::path>& tried) {
  tried.clear();
  if (name.empty()) return {};
  const fs::path wanted = name;
  std::error_code error;
  // An absolute path stands for itself under every folder.
  for (const fs::path& folder : inputFolders(scene))
    if (const fs::path place = (folder / wanted).lexically_normal();
        std::find(tried.begin(), tried.end(), place) == tried.end())
      tried.push_back(place);
  for (const fs::path& candidate : tried)
    if (fs::is_regular_file(candidate, error)) return fs::weakly_canonical(candidate);
  return {};
}

} // namespace grouser::support

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/locations.hpp"

#include <cstdlib>
#include <system_error>

namespace grouser::runs {

namespace fs = std::filesystem;

fs::path shareFolder() {
  if (const char* set = std::getenv("GROUSER_SHARE"); set && *set) return set;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path beside = program.parent_path().parent_path() / "share" / "grouser";
    if (fs::is_directory(beside, error)) return beside;
  }
  return GROUSER_SHARE_FOLDER;
}

fs::path findInput(const std::string& name, const fs::path& scene, std::vector<fs::path>& tried) {
  const fs::path wanted = name;
  if (wanted.is_absolute()) {
    tried = {wanted};
  } else {
    tried = {fs::absolute(scene).parent_path() / wanted, fs::absolute(wanted), shareFolder() / "assets" / wanted};
  }
  std::error_code error;
  for (const fs::path& candidate : tried)
    if (fs::is_regular_file(candidate, error)) return fs::weakly_canonical(candidate);
  return {};
}

} // namespace grouser::runs

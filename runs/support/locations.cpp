// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/locations.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/table.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

namespace grouser::support {

namespace fs = std::filesystem;

namespace {

const char* installedShare = nullptr;

} // namespace

void setInstalledShare(const char* folder) { installedShare = folder; }

fs::path ownFile() {
  Dl_info own{};
  const bool known = dladdr(reinterpret_cast<const void*>(&ownFile), &own) != 0 && own.dli_fname;
  const std::string name = known ? own.dli_fname : "";
  return name.find(".so") != std::string::npos ? name : "/proc/self/exe";
}

fs::path shareFolder() {
  if (const char* set = std::getenv("GROUSER_SHARE"); set && *set) return set;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    fs::path beside = program.parent_path().parent_path() / "share" / "grouser";
    if (fs::is_directory(beside, error)) return beside;
  }
  // A module is in a folder such as PREFIX/lib/python3/dist-packages/grouser.
  if (const fs::path own = fs::absolute(ownFile(), error); own != "/proc/self/exe")
    for (fs::path folder = own.parent_path(); folder != folder.parent_path(); folder = folder.parent_path())
      if (fs::is_directory(folder / "share" / "grouser", error)) return folder / "share" / "grouser";
  // A user's program that links an installed library may be in any folder.
  if (installedShare && fs::is_directory(installedShare, error)) return installedShare;
  for (const char* installed : {"/usr/local/share/grouser", "/usr/share/grouser"})
    if (!fs::is_directory(GROUSER_SHARE_FOLDER, error) && fs::is_directory(installed, error)) return installed;
  return GROUSER_SHARE_FOLDER;
}

void requireShareFolder() {
  std::error_code error;
  const char* set = std::getenv("GROUSER_SHARE");
  if (set && *set && !fs::is_directory(set, error))
    throw base::InputError(
        fmt::format("GROUSER_SHARE = {} is not a folder; set it to the folder that contains assets and "
                    "runs, or unset it",
                    set));
}

std::vector<fs::path> inputFolders(const fs::path& scene) {
  std::error_code error;
  return {fs::absolute(scene, error).parent_path(), fs::current_path(error), shareFolder() / "assets"};
}

fs::path findInput(const std::string& name, const fs::path& scene, std::vector<fs::path>& tried) {
  tried.clear();
  if (name.empty() || name.find('\0') != std::string::npos) return {}; // the system ends a path at a NUL
  const fs::path wanted = name;
  std::error_code error;
  // An absolute path is the same for every folder.
  for (const fs::path& folder : inputFolders(scene))
    if (const fs::path place = (folder / wanted).lexically_normal();
        std::find(tried.begin(), tried.end(), place) == tried.end())
      tried.push_back(place);
  for (const fs::path& candidate : tried)
    if (fs::is_regular_file(candidate, error)) {
      base::requireInput(candidate, "set the path of a file");
      return fs::weakly_canonical(candidate);
    }
  for (const fs::path& candidate : tried)
    if (fs::is_symlink(candidate, error) || fs::exists(candidate, error))
      base::requireInput(candidate, "set the path of a file");
  return {};
}

std::string nearestFileHint(const fs::path& wanted, const std::vector<fs::path>& folders) {
  const std::string stem = wanted.stem().string();
  const bool isBare = !wanted.has_extension();
  std::error_code error;
  std::vector<fs::path> all = {fs::absolute(wanted, error).parent_path()};
  all.insert(all.end(), folders.begin(), folders.end());
  fs::path best;
  int least = 1 + static_cast<int>(stem.size() / 3); // maximum number of edits for a similar name
  for (const fs::path& folder : all)
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (!isBare && entry.path().extension() != wanted.extension()) continue;
      const int edits = base::editDistance(stem, entry.path().stem().string());
      if (edits < least && entry.is_regular_file(error)) least = edits, best = entry.path();
    }
  if (best.empty()) return "";
  const fs::path near = best.lexically_proximate(fs::current_path(error));
  return fmt::format("did you mean {}? ", near.string().size() < best.string().size() ? near.string() : best.string());
}

} // namespace grouser::support

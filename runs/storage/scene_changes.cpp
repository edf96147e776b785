// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/scene_changes.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <sstream>

namespace grouser::storage {

namespace {

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Returns true for keys that do not affect the state, or that name files compared by content.
bool isFree(const std::string& key) {
  constexpr const char* kFree[] = {
      "run.duration",      "run.output_interval", "run.frame_interval", "run.checkpoint_interval",
      "run.device",        "run.threads",         "run.skin",           "run.max_overlap",
      "terrain.heightmap", "terrain.cache",       "vehicle.spec"};
  const bool soil = key.rfind("material.", 0) == 0 && (key.ends_with("\".soil") || key.ends_with("\".soil_hash"));
  return soil || key.rfind("output.", 0) == 0 || key.rfind("stop.", 0) == 0 || key.rfind("parallel.", 0) == 0 ||
         std::find(std::begin(kFree), std::end(kFree), key) != std::end(kFree);
}

/// "section.key" and value for all keys of a resolved scene, in the order of the scene; sections of a list are
/// numbered.
std::vector<std::pair<std::string, std::string>> entriesOf(const std::string& resolved) {
  std::vector<std::pair<std::string, std::string>> entries;
  std::map<std::string, int> count;
  std::string section;
  for (const std::string& line : linesOf(resolved)) {
    if (line.rfind("[[", 0) == 0) {
      const std::string name = line.substr(2, line.size() - 4);
      section = fmt::format("{}[{}].", name, count[name]++);
    } else if (line.rfind('[', 0) == 0) {
      section = line.substr(1, line.size() - 2) + ".";
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      const std::string key = section + line.substr(0, equals);
      if (!isFree(key)) entries.emplace_back(key, line.substr(equals + 3));
    }
  }
  return entries;
}

} // namespace

std::vector<KeyChange> changedKeys(const std::string& was, const std::string& is) {
  const auto before = entriesOf(was), after = entriesOf(is);
  const std::map<std::string, std::string> then(before.begin(), before.end()), now(after.begin(), after.end());
  std::vector<KeyChange> changes;
  for (const auto& [key, value] : after) {
    const auto old = then.find(key);
    if (old == then.end())
      changes.push_back({key, {}, value});
    else if (old->second != value)
      changes.push_back({key, old->second, value});
  }
  for (const auto& [key, value] : before)
    if (!now.contains(key)) changes.push_back({key, value, {}});
  return changes;
}

bool actsInTheDrive(const std::string& key) {
  constexpr const char* kDriver[] = {"driver.sprocket_speed", "driver.left",        "driver.right",
                                     "driver.torque",         "driver.left_torque", "driver.right_torque",
                                     "driver.drive_ramp"};
  constexpr const char* kSections[] = {"driver.table.", "driver.torques.", "driver.course.", "hitch."};
  return std::find(std::begin(kDriver), std::end(kDriver), key) != std::end(kDriver) ||
         std::any_of(std::begin(kSections), std::end(kSections), [&](auto s) { return key.starts_with(s); });
}

std::string changedFile(const std::string& was, const std::string& is) {
  const auto then = linesOf(was);
  for (const std::string& file : linesOf(is))
    if (std::find(then.begin(), then.end(), file) == then.end()) return file.substr(0, file.find(' '));
  return "";
}

BranchChanges checkSameScene(const Checkpoint& checkpoint, const std::filesystem::path& path,
                             const setup::Provenance& provenance, const char* option) {
  const auto refuse = [&](const std::string& what) {
    throw base::InputError(
        fmt::format("{}: {}; restore it, or start a new run without {}", provenance.file.string(), what, option));
  };
  BranchChanges branch;
  for (const auto& [key, was, is] : changedKeys(checkpoint.scene, provenance.resolved)) {
    if (actsInTheDrive(key))
      (key.starts_with("hitch.") ? branch.hitch : branch.driver) = true;
    else if (!was)
      refuse(fmt::format("{} = {} is not in the scene of {}", key, *is, path.string()));
    else if (!is)
      refuse(fmt::format("{} = {} is missing in this scene, but {} was written with it", key, *was, path.string()));
    else
      refuse(fmt::format("{} = {} was {} when {} was written", key, *is, *was, path.string()));
  }
  if (const std::string file = changedFile(checkpoint.inputs, provenance.inputs); !file.empty())
    refuse(fmt::format("the file of {} has changed since {} was written", file, path.string()));
  return branch;
}

} // namespace grouser::storage

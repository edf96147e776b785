// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/sweep_plan.hpp"

#include "base/error.hpp"
#include "runs/commands/plan.hpp"
#include "runs/setup/load_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace grouser::commands {

using base::InputError;

namespace {

constexpr std::size_t kLongestName = 120; // of a folder; the file system allows 255

struct Axis {
  std::string key;
  std::vector<std::string> values;
};

std::string trimmed(std::string_view text) {
  const auto isSpace = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return std::string(text);
}

/// Position of the = between key and value: a key in quotes may hold one.
std::size_t equalsSign(const std::string& set) {
  bool inQuotes = false;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set[i] == '"') inQuotes = !inQuotes;
    if (set[i] == '=' && !inQuotes) return i;
  }
  return std::string::npos;
}

Axis axisOf(const std::string& set) {
  const std::size_t equals = equalsSign(set);
  if (equals == std::string::npos || equals == 0)
    throw InputError(fmt::format(
        "--set {}: no value is given; write key=value,value..., e.g. --set driver.sprocket_speed=1,2", set));
  Axis axis{set.substr(0, equals), splitValues(std::string_view(set).substr(equals + 1))};
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    if (axis.values[i].empty())
      throw InputError(fmt::format("--set {}: value {} of the list is empty; remove a comma", set, i + 1));
    if (std::count(axis.values.begin(), axis.values.end(), axis.values[i]) > 1)
      throw InputError(fmt::format("--set {}: {} stands there twice; remove one", set, axis.values[i]));
  }
  return axis;
}

std::string lastWord(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// The key's last word where that tells it from the others, else the whole key: an entry of a list is no word.
std::string shortName(const std::string& key, const std::vector<Axis>& axes) {
  const std::string last = lastWord(key);
  const auto alike = std::count_if(axes.begin(), axes.end(), [&](const Axis& a) { return lastWord(a.key) == last; });
  const bool isEntry = std::all_of(last.begin(), last.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return alike > 1 || isEntry ? key : last;
}

/// What every file system and shell takes as it is.
std::string plainText(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const bool isPlain = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' || c == '_';
    if (isPlain)
      plain += c;
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  return plain;
}

std::string folderName(const std::vector<Axis>& swept, const std::vector<std::string>& values,
                       std::set<std::string>& taken) {
  std::string name;
  for (std::size_t k = 0; k < swept.size(); ++k)
    name += fmt::format("{}{}={}", k ? "," : "", plainText(shortName(swept[k].key, swept)), plainText(values[k]));
  name.resize(std::min(name.size(), kLongestName));
  std::string unique = name;
  for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}~{}", name, n);
  return unique;
}

} // namespace

std::vector<std::string> splitValues(std::string_view list) {
  std::vector<std::string> values;
  std::size_t begin = 0;
  int depth = 0;
  char quote = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const char c = list[i];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth <= 0) {
      values.push_back(trimmed(list.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  values.push_back(trimmed(list.substr(begin)));
  return values;
}

SweepPlan planSweep(const std::filesystem::path& scene, const std::vector<std::string>& sets,
                    const std::vector<std::string>& fixed) {
  std::vector<Axis> swept;
  std::vector<std::string> same = fixed;
  std::set<std::string> keys;
  for (const std::string& set : sets) {
    const Axis axis = axisOf(set);
    if (!keys.insert(axis.key).second)
      throw InputError(fmt::format("--set {}: {} is given twice; join its values with commas", set, axis.key));
    if (axis.values.size() > 1)
      swept.push_back(axis);
    else
      same.push_back(axis.key + "=" + axis.values.front());
  }
  if (swept.empty()) {
    for (const std::string& set : sets) swept.push_back(axisOf(set));
    same = fixed;
  }
  if (swept.empty())
    throw InputError("sweep: no key is given; add e.g. --set driver.sprocket_speed=0.5,1,2, or use grouser run");

  SweepPlan plan;
  plan.scene = scene;
  for (const Axis& axis : swept) plan.keys.push_back(axis.key);
  std::set<std::string> taken;
  std::vector<std::size_t> at(swept.size(), 0);
  for (bool more = true; more;) {
    SweepRun run;
    run.overrides = same;
    for (std::size_t k = 0; k < swept.size(); ++k) {
      run.values.push_back(swept[k].values[at[k]]);
      run.overrides.push_back(swept[k].key + "=" + run.values.back());
    }
    run.name = folderName(swept, run.values, taken);
    run.scene = setup::loadScene(scene, run.overrides);
    planText(run.scene); // reads spec and height-map, lays out the bed, chooses the step: throws where a run would
    plan.runs.push_back(std::move(run));
    // Count up, the last key fastest.
    more = false;
    for (std::size_t k = swept.size(); k-- > 0 && !more;) {
      at[k] = (at[k] + 1) % swept[k].values.size();
      more = at[k] != 0;
    }
  }
  return plan;
}

} // namespace grouser::commands

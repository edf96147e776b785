// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include "base/error.hpp"
#include "base/name_fault.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/campaigns/sweeps/sweep_files.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <set>

namespace grouser::sweeps {

using base::InputError;

namespace {

constexpr std::size_t kLongestName = 120; // maximum length of folder names; file systems allow 255

/// The value without quotes and blanks around words, and with all numbers in one form: equal for "[0.1, 2]" and
/// "[1e-1,2.0]".
std::string oneForm(const std::string& value) {
  const auto isOfWord = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '+' || c == '-';
  };
  const auto isQuote = [](char c) { return c == '"' || c == '\''; };
  std::string form;
  for (std::size_t i = 0; i < value.size();) {
    if (isQuote(value[i])) {
      const std::size_t end = std::min(value.find(value[i], i + 1), value.size());
      form += value.substr(i + 1, end - i - 1), i = end + 1;
      continue;
    }
    std::string word;
    for (; i < value.size() && isOfWord(value[i]); ++i) word += value[i];
    std::string digits = word;
    std::erase(digits, '_'); // separates digits in TOML
    char* end = nullptr;
    const double number = std::strtod(digits.c_str(), &end);
    const bool isNumber = end != digits.c_str() && *end == 0 && !std::isalpha(static_cast<unsigned char>(word.front()));
    form += isNumber ? fmt::format("{}", number + 0.0) : word; // -0 becomes 0
    if (i < value.size() && !isQuote(value[i])) {
      if (value[i] != ' ' && value[i] != '\t') form += value[i];
      ++i;
    }
  }
  return form;
}

/// One value of an axis.
struct Point {
  std::string label;                  ///< as given: "0.5", "deep"
  std::vector<std::string> overrides; ///< "key=value"
};

struct Axis {
  std::string key;
  std::vector<Point> points;
};

std::string trimmed(std::string_view text) {
  const auto isSpace = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return std::string(text);
}

Axis axisOf(const std::string& set) {
  const KeyValues given = keyValues(set, "--set", "driver.sprocket_speed=1,2");
  if (given.key == "output.folder")
    throw InputError(
        fmt::format("--set {}: a sweep chooses the folder of each run; set the folder of the sweep with --out", set));
  Axis axis{given.key, {}};
  for (const std::string& value : given.values) axis.points.push_back({value, {axis.key + "=" + value}});
  return axis;
}

/// Whether this is a valid folder name that differs from the sweep's files, from . and from ..
bool isFolderName(const std::string& label) {
  const std::string plain = plainText(label);
  return plain.find_first_not_of('.') != std::string::npos &&
         std::find(kSweepFiles.begin(), kSweepFiles.end(), plain) == kSweepFiles.end();
}

/// "NAME: key=value, key=value"
Point caseOf(const std::string& text) {
  const std::size_t colon = text.find(':');
  Point point{trimmed(std::string_view(text).substr(0, colon)), {}};
  if (point.label.empty() || point.label.find_first_of("=,\"") != std::string::npos)
    throw InputError(fmt::format("--case {}: a case must start with its name; write NAME: key=value, key=value..., "
                                 "e.g. --case 'deep: terrain.depth=0.6'",
                                 text));
  if (const std::string fault = base::textFault(point.label, base::kLongestName); !fault.empty())
    throw InputError(fmt::format("--case {}: its name {}", text, fault));
  if (!isFolderName(point.label))
    throw InputError(
        fmt::format("--case {}: '{}' cannot be used as a folder name beside {}; use letters (a to z) or digits", text,
                    point.label, kSummaryFile));
  if (colon == std::string::npos || trimmed(std::string_view(text).substr(colon + 1)).empty()) return point;
  for (const std::string& set : splitValues(std::string_view(text).substr(colon + 1))) {
    const std::size_t equals = equalsSign(set);
    if (equals == std::string::npos || equals == 0 || equals + 1 == set.size())
      throw InputError(fmt::format("--case {}: '{}' is not of the form key=value", text, set));
    point.overrides.push_back(set);
  }
  return point;
}

Axis caseAxis(const std::vector<std::string>& cases) {
  Axis axis{kCaseKey, {}};
  for (const std::string& text : cases) {
    const Point point = caseOf(text);
    for (const Point& p : axis.points)
      if (p.label == point.label)
        throw InputError(fmt::format("--case {}: two cases have this name; rename one", p.label));
    axis.points.push_back(point);
  }
  return axis;
}

Axis seedAxis(int seeds) {
  Axis axis{kSeedKey, {}};
  for (int seed = 1; seed <= seeds; ++seed)
    axis.points.push_back({fmt::format("{}", seed), {fmt::format("{}={}", kSeedKey, seed)}});
  return axis;
}

/// Throws if two axes, or a case twice, set the same key. A case may override a key with a single value in --set.
void checkKeysApart(const std::vector<Axis>& axes) {
  std::set<std::string> ofCases, before;
  for (const Axis& axis : axes) {
    const bool isCase = axis.key == kCaseKey;
    for (const Point& p : isCase ? axis.points : std::vector<Point>{}) {
      std::set<std::string> here;
      for (const std::string& set : p.overrides)
        if (!here.insert(keyOf(set)).second)
          throw InputError(fmt::format("--case {}: {} is set twice; remove one", p.label, keyOf(set)));
      ofCases.merge(here);
    }
    if (isCase) continue;
    const std::string key = keyOf(axis.key);
    if (!before.insert(key).second)
      throw InputError(
          fmt::format("sweep: {} is set twice; set it once, with its values separated by commas", axis.key));
    if (axis.points.size() > 1 && ofCases.contains(key))
      throw InputError(fmt::format(
          "sweep: {} has {} values, but a --case also sets it; use a single value, or remove it from the case",
          axis.key, axis.points.size()));
  }
}

std::string lastWord(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// Last word of the key; the whole key if this word is not unique or is the number of a list entry.
std::string shortName(const std::string& key, const std::vector<Axis>& axes) {
  const std::string last = lastWord(key);
  const auto alike = std::count_if(axes.begin(), axes.end(), [&](const Axis& a) { return lastWord(a.key) == last; });
  const bool isEntry = std::all_of(last.begin(), last.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return alike > 1 || isEntry ? key : last;
}

std::string folderName(const std::vector<Axis>& swept, const std::vector<std::string>& values,
                       std::set<std::string>& taken) {
  std::string name;
  for (std::size_t k = 0; k < swept.size(); ++k) {
    const std::string key = swept[k].key == kCaseKey ? "" : plainText(shortName(swept[k].key, swept)) + "=";
    name += (k ? "," : "") + key + plainText(values[k]);
  }
  name.resize(std::min(name.size(), kLongestName));
  std::string unique = name;
  for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}~{}", name, n);
  return unique;
}

/// Reason why a run with these overrides is invalid; empty if it is valid. Reads vehicle file and height-map, lays out
/// the bed, and chooses the step.
std::string faultOf(const std::filesystem::path& file, const std::vector<std::string>& overrides, scene::Scene& scene) {
  try {
    scene = setup::loadScene(file, overrides);
    checkScene(scene);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Error message that mentions --case NAME instead of --set for the keys of a case.
std::string namedFault(const std::string& fault, const std::string& name) {
  const std::string set = "--set";
  if (fault.rfind(set + " ", 0) == 0) return fmt::format("--case {}:{}", name, fault.substr(set.size()));
  return fmt::format("--case {}{}", name, fault.rfind(set + ":", 0) == 0 ? fault.substr(set.size()) : ": " + fault);
}

/// Loads and checks the scene of one run.
scene::Scene checkedScene(const std::filesystem::path& file, const SweepRun& run, const Point* ofCase) {
  scene::Scene scene;
  const std::string fault = faultOf(file, run.overrides, scene);
  if (fault.empty()) return scene;
  if (!ofCase) throw InputError(fault);
  std::vector<std::string> others = run.overrides;
  std::erase_if(others, [&](const std::string& o) {
    return std::find(ofCase->overrides.begin(), ofCase->overrides.end(), o) != ofCase->overrides.end();
  });
  throw InputError(faultOf(file, others, scene) == fault ? fault : namedFault(fault, ofCase->label));
}

/// Axes of all lists, in the order of the swept keys.
std::vector<Axis> axesOf(const SweepLists& lists) {
  std::vector<Axis> axes;
  if (!lists.cases.empty()) axes.push_back(caseAxis(lists.cases));
  for (const std::string& set : lists.sets) axes.push_back(axisOf(set));
  if (lists.seeds > 0) axes.push_back(seedAxis(lists.seeds));
  checkKeysApart(axes);
  return axes;
}

/// Throws if two runs have equal scenes, such as those of "--case a: x=1" and "--case b: x=1.0".
void checkRunsDiffer(const SweepPlan& plan) {
  std::map<std::string, std::string> nameOf;
  for (const SweepRun& run : plan.runs)
    if (const auto [same, isNew] = nameOf.try_emplace(scene::resolvedToml(run.scene), run.name); !isNew)
      throw InputError(fmt::format("sweep: the runs {} and {} are equal, because all keys have the same values; remove "
                                   "one of the values or cases",
                                   same->second, run.name));
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

KeyValues keyValues(const std::string& set, const std::string& option, const std::string& example) {
  const std::size_t equals = equalsSign(set);
  if (equals == std::string::npos || equals == 0)
    throw InputError(
        fmt::format("{} {}: value is missing; write key=value,value..., e.g. {} {}", option, set, option, example));
  KeyValues given{set.substr(0, equals), splitValues(std::string_view(set).substr(equals + 1))};
  for (std::size_t i = 0; i < given.values.size(); ++i) {
    if (given.values[i].empty())
      throw InputError(fmt::format("{} {}: value {} of the list is empty; remove the extra comma", option, set, i + 1));
    for (std::size_t k = 0; k < i; ++k)
      if (given.values[k] == given.values[i])
        throw InputError(fmt::format("{} {}: {} is listed twice; remove one", option, set, given.values[i]));
      else if (oneForm(given.values[k]) == oneForm(given.values[i]))
        throw InputError(fmt::format("{} {}: {} and {} are the same value; remove one", option, set, given.values[k],
                                     given.values[i]));
  }
  return given;
}

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

SweepPlan planSweep(const std::filesystem::path& scene, const SweepLists& lists,
                    const std::vector<std::string>& fixed) {
  const std::vector<Axis> axes = axesOf(lists);
  if (axes.empty())
    throw InputError("sweep: nothing to vary; add e.g. --set driver.sprocket_speed=0.5,1,2 or --seeds 3, or use "
                     "grouser run");
  const auto varies = [](const Axis& a) { return a.points.size() > 1 || a.key == kCaseKey; };
  const bool any = std::any_of(axes.begin(), axes.end(), varies);
  std::vector<Axis> swept;
  std::vector<std::string> same = fixed;
  for (const Axis& axis : axes)
    if (varies(axis) || !any)
      swept.push_back(axis);
    else
      for (const std::string& set : axis.points[0].overrides) putOverride(same, set);

  SweepPlan plan;
  plan.scene = scene;
  for (const Axis& axis : swept) plan.keys.push_back(axis.key);
  std::set<std::string> taken;
  std::vector<std::size_t> at(swept.size(), 0);
  for (bool more = true; more;) {
    SweepRun run;
    const Point* ofCase = nullptr;
    run.overrides = same;
    for (std::size_t k = 0; k < swept.size(); ++k) {
      const Point& point = swept[k].points[at[k]];
      if (swept[k].key == kCaseKey) ofCase = &point;
      run.values.push_back(point.label);
      for (const std::string& set : point.overrides) putOverride(run.overrides, set);
    }
    run.name = folderName(swept, run.values, taken);
    run.scene = checkedScene(scene, run, ofCase);
    plan.runs.push_back(std::move(run));
    // Count up, the last key fastest.
    more = false;
    for (std::size_t k = swept.size(); k-- > 0 && !more;) {
      at[k] = (at[k] + 1) % swept[k].points.size();
      more = at[k] != 0;
    }
  }
  checkRunsDiffer(plan);
  return plan;
}

} // namespace grouser::sweeps

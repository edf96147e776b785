// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/overrides.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace grouser::sweeps {

std::size_t equalsSign(const std::string& set) {
  bool inQuotes = false;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set[i] == '"') inQuotes = !inQuotes;
    if (set[i] == '=' && !inQuotes) return i;
  }
  return std::string::npos;
}

std::string keyOf(const std::string& set) {
  std::string key = set.substr(0, equalsSign(set));
  std::erase(key, '"');
  return key;
}

void checkGivenOnce(const std::vector<std::string>& overrides) {
  std::map<std::string, std::string> before;
  for (const std::string& set : overrides) {
    const auto [other, fresh] = before.emplace(keyOf(set), set);
    if (fresh) continue;
    const auto value = [](const std::string& s) { return s.substr(std::min(s.size(), equalsSign(s) + 1)); };
    const bool hasOption = other->first == "run.device" || other->first == "run.threads";
    throw base::InputError(fmt::format("--set: {} is set twice, as {} and as {}; remove one{}", other->first,
                                       value(other->second), value(set),
                                       hasOption ? fmt::format(" (--{} also sets it)", other->first.substr(4)) : ""));
  }
}

void putOverride(std::vector<std::string>& overrides, const std::string& set) {
  std::erase_if(overrides, [&](const std::string& o) { return keyOf(o) == keyOf(set); });
  overrides.push_back(set);
}

} // namespace grouser::sweeps

// SPDX-License-Identifier: BSD-3-Clause
#include "base/nearest_key.hpp"

#include "base/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace grouser::base {

namespace {

constexpr std::size_t kMaxNamed = 3;   ///< maximum number of suggested keys
constexpr std::size_t kTellingKey = 3; ///< minimum length of a key that identifies its section; x and z occur in many
constexpr int kOtherSection = 2;       ///< maximum penalty for another section; less than the cost of one wrong letter

std::string sectionOf(const std::string& full) { return full.substr(0, full.rfind('.')); }
std::string keyOf(const std::string& full) { return full.substr(full.rfind('.') + 1); }

/// True if `part` is one of the words of a key such as sprocket_speed.
bool isPartOf(const std::string& part, const std::string& whole) {
  return ("_" + whole + "_").find("_" + part + "_") != std::string::npos;
}

/// Edit cost: twice the number of edits; a word of the key counts as one and a half edits.
int distance(const std::string& word, const std::string& key) {
  const int edits = 2 * editDistance(word, key);
  return isPartOf(word, key) || isPartOf(key, word) ? std::min(edits, 3) : edits;
}

/// True if a key is near enough for a suggestion: at most a third of the letters are wrong.
bool isNear(int distance, const std::string& word) {
  return distance <= std::max(2, static_cast<int>(2 * word.size() / 3));
}

/// Returns the keys nearest to `key` in the section `path`, which may be misspelt or another section.
std::vector<std::string> nearestKeys(const std::string& path, const std::string& key,
                                     const std::vector<std::string>& all) {
  std::vector<std::string> best;
  int least = std::numeric_limits<int>::max();
  for (const std::string& full : all) {
    const int ofKey = distance(key, keyOf(full));
    if (!isNear(ofKey, key)) continue;
    const std::string section = sectionOf(full);
    const int away = path.empty() ? 0 : std::min(editDistance(path, section), editDistance(path, keyOf(section)));
    const int d = 4 * ofKey + std::min(kOtherSection, away);
    if (d < least) best.clear();
    if (d <= least) least = d, best.push_back(full);
  }
  return best.size() > kMaxNamed ? std::vector<std::string>() : best;
}

} // namespace

InputError amongAllKeys(const UnknownKey& unknown, const std::vector<std::string>& all) {
  const UnknownKey::Place& place = unknown.place();
  const bool isSection = !place.inner.empty();
  const std::string local = nearestWord(place.key, place.valid);
  const int here = local.empty() ? std::numeric_limits<int>::max() : distance(place.key, local);
  std::vector<std::string> found;
  if (!isSection) {
    found = nearestKeys(place.path, place.key, all);
    if (!found.empty() && isNear(here, place.key) && here <= distance(place.key, keyOf(found.front()))) found.clear();
  } else if (!isNear(here, place.key) && place.inner.front().size() >= kTellingKey) {
    found = nearestKeys(place.path.empty() ? place.key : place.path + "." + place.key, place.inner.front(), all);
  }
  return found.empty() ? InputError(unknown.what())
                       : InputError(UnknownKey::message(place, fmt::format("{}", fmt::join(found, " or "))));
}

} // namespace grouser::base

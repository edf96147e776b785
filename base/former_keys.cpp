// SPDX-License-Identifier: BSD-3-Clause
// Renamed keys: files with the former name are accepted for one more version.
#include "base/table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::base {

namespace {

/// Returns all sections selected by `where`, each with a path for messages.
std::vector<std::pair<Node*, std::string>> sectionsAt(Node& node, const std::string& path, const std::string& where) {
  std::vector<std::pair<Node*, std::string>> found;
  const auto add = [&](Node& child, const std::string& name, const std::string& rest) {
    for (auto& place : sectionsAt(child, path.empty() ? name : path + "." + name, rest)) found.push_back(place);
  };
  if (auto* list = std::get_if<Node::List>(&node.value)) {
    for (std::size_t i = 0; i < list->size(); ++i) add((*list)[i], std::to_string(i), where);
  } else if (auto* map = std::get_if<Node::Map>(&node.value)) {
    if (where.empty()) return {{&node, path}};
    const std::size_t dot = where.find('.');
    const std::string first = where.substr(0, dot), rest = dot == std::string::npos ? "" : where.substr(dot + 1);
    for (Node::Entry& e : *map)
      if (first == "*" || first == e.key) add(e.node, e.key, rest);
  }
  return found;
}

} // namespace

void Document::renameKeys(const std::string& where, const std::vector<FormerKey>& keys) {
  for (const FormerKey& key : keys) {
    const std::string &former = key.former, &now = key.now;
    bool isNoted = false;
    for (const auto& [section, path] : sectionsAt(root_, "", where)) {
      auto& map = std::get<Node::Map>(section->value);
      const auto entry = std::find_if(map.begin(), map.end(), [&](const Node::Entry& e) { return e.key == former; });
      if (entry == map.end()) continue;
      if (const Node* other = section->find(now))
        throw InputError(fmt::format("{}: {}.{} is the former name of {}.{}, which is also set at {}; remove {}",
                                     entry->node.origin, path, former, path, now, other->origin, former));
      entry->key = now;
      if (!isNoted)
        notes_.push_back(fmt::format("{}: {}.{} is now called {}; rename it (the next version rejects the old name)",
                                     entry->node.origin, path, former, now));
      isNoted = true;
    }
  }
}

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
// Adds derived keys, which are then read as if they were in the file.
#include "base/table.hpp"

#include <fmt/format.h>

namespace grouser::base {

namespace {

/// Returns the table `key` of `parent`; adds the table if it is missing.
Node& tableAt(Node& parent, const std::string& key, const std::string& path, const std::string& origin) {
  Node* child = parent.find(key);
  if (!child) {
    auto& map = std::get<Node::Map>(parent.value);
    map.push_back({key, Node{origin, Node::Map{}}});
    child = &map.back().node;
  }
  if (!child->isMap())
    throw InputError(fmt::format("{}: {} has the wrong type; make it a table: [{}]", child->origin, path, path));
  return *child;
}

} // namespace

void Document::supply(const std::string& section, const std::string& name, const std::string& key,
                      const std::string& text, const std::string& origin) {
  Node& table = tableAt(tableAt(root_, section, section, origin), name, section + "." + name, origin);
  table.origin = origin;
  if (!table.find(key)) std::get<Node::Map>(table.value).push_back({key, Node{origin, text}});
}

void Document::put(const std::string& section, const std::string& key, const Node& value) {
  Node& table = tableAt(root_, section, section, value.origin);
  if (Node* there = table.find(key))
    *there = value;
  else
    std::get<Node::Map>(table.value).push_back({key, value});
}

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
// The only file that includes toml++: converts its tree, and applies overrides.
#include "base/input_file.hpp"
#include "base/table.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace grouser::base {

namespace {

constexpr std::int64_t kVersion = 1;

Node convert(const toml::node& from, const std::string& file) {
  Node to;
  to.origin = fmt::format("{}:{}", file, from.source().begin.line);
  if (const auto* table = from.as_table()) {
    Node::Map map;
    for (const auto& [key, child] : *table) map.push_back({std::string(key.str()), convert(child, file)});
    to.value = std::move(map);
  } else if (const auto* array = from.as_array()) {
    Node::List list;
    for (const auto& child : *array) list.push_back(convert(child, file));
    to.value = std::move(list);
  } else if (const auto* text = from.as_string()) {
    to.value = text->get();
  } else if (const auto* whole = from.as_integer()) {
    to.value = whole->get();
  } else if (const auto* real = from.as_floating_point()) {
    to.value = real->get();
  } else if (const auto* flag = from.as_boolean()) {
    to.value = flag->get();
  } else {
    throw InputError(
        fmt::format("{}: dates and times are not supported; remove the value or put it in quotes", to.origin));
  }
  return to;
}

/// Restores file order, which messages and resolved copies use; toml++ sorts keys alphabetically.
void sortByLine(Node& node, const toml::node& from) {
  if (const auto* table = from.as_table()) {
    auto& map = std::get<Node::Map>(node.value);
    const auto place = [&](const Node::Entry& e) {
      const toml::key* key = nullptr;
      for (const auto& [k, child] : *table)
        if (k.str() == e.key) key = &k;
      return std::pair{key->source().begin.line, key->source().begin.column};
    };
    for (Node::Entry& e : map) sortByLine(e.node, *table->get(e.key));
    std::stable_sort(map.begin(), map.end(),
                     [&](const Node::Entry& a, const Node::Entry& b) { return place(a) < place(b); });
  } else if (const auto* array = from.as_array()) {
    auto& list = std::get<Node::List>(node.value);
    for (std::size_t i = 0; i < list.size(); ++i) sortByLine(list[i], *array->get(i));
  }
}

/// Error message for a number that a double or a 64-bit integer cannot represent; empty for other syntax errors.
std::string rangeFault(std::string_view description) {
  const std::size_t begin = description.find('\''), end = description.find('\'', begin + 1);
  if (begin == std::string_view::npos || end == std::string_view::npos) return "";
  std::string number(description.substr(begin + 1, end - begin - 1));
  if (description.find("not representable in 64 bits") != std::string_view::npos)
    return fmt::format("{} is out of the range of integers (64 bits); use a smaller number, or a decimal point",
                       number);
  std::erase(number, '_');
  char* rest = nullptr;
  const double value = std::strtod(number.c_str(), &rest);
  const bool isDecimal = number.find_first_not_of("+-.0123456789eE") == std::string::npos; // not "inf"
  if (*rest || number.empty() || !isDecimal || !std::isinf(value)) return "";
  return fmt::format("{} is out of the range of double precision, 1.8e308; use a smaller number", number);
}

Node parseToml(std::string_view text, const std::string& name) {
  try {
    const toml::table table = toml::parse(text, name);
    Node node = convert(table, name);
    sortByLine(node, table);
    return node;
  } catch (const toml::parse_error& e) {
    if (const std::string fault = rangeFault(e.description()); !fault.empty())
      throw InputError(fmt::format("{}:{}: the number {}", name, e.source().begin.line, fault));
    throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}; correct the syntax", name, e.source().begin.line,
                                 e.source().begin.column, e.description()));
  }
}

/// Splits a path such as `contact."a|b".friction` at its dots.
std::vector<std::string> splitKey(std::string_view key, const std::string& whole) {
  std::vector<std::string> parts(1);
  bool inQuotes = false;
  for (const char c : key) {
    if (c == '"')
      inQuotes = !inQuotes;
    else if (c == '.' && !inQuotes)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  if (inQuotes || std::any_of(parts.begin(), parts.end(), [](const std::string& p) { return p.empty(); }))
    throw InputError(
        fmt::format("--set {}: the key is not of the form section.key; write e.g. --set run.duration=2", whole));
  return parts;
}

void setOrigin(Node& node, const std::string& origin) {
  node.origin = origin;
  if (auto* map = std::get_if<Node::Map>(&node.value))
    for (Node::Entry& e : *map) setOrigin(e.node, origin);
  if (auto* list = std::get_if<Node::List>(&node.value))
    for (Node& n : *list) setOrigin(n, origin);
}

/// Value of the override `whole`: `text` parsed as TOML if valid, else plain text.
Node overrideValue(const std::string& text, const std::string& whole) {
  Node node;
  try {
    const toml::table table = toml::parse("value = " + text);
    if (table.size() == 1)
      node = convert(*table.get("value"), "--set");
    else
      node.value = text;
  } catch (const toml::parse_error& e) {
    if (const std::string fault = rangeFault(e.description()); !fault.empty())
      throw InputError(fmt::format("--set {}: the number {}", whole, fault));
    node.value = text;
  }
  setOrigin(node, "--set");
  return node;
}

/// Returns the node of a key; null if the key is absent.
Node* nodeAt(Node& root, const std::vector<std::string>& parts) {
  Node* node = &root;
  for (const std::string& part : parts)
    if (!node || !(node = node->find(part))) return nullptr;
  return node;
}

/// Removes a key: "~a.b.c".
void removeKey(Node& root, const std::string& text) {
  std::vector<std::string> parts = splitKey(std::string_view(text).substr(1), text);
  const std::string last = parts.back();
  parts.pop_back();
  Node* section = nodeAt(root, parts);
  if (!section || !section->find(last))
    throw InputError(
        fmt::format("--set {}: the file has no key {} to remove; correct or remove this --set", text, text.substr(1)));
  std::erase_if(std::get<Node::Map>(section->value), [&](const Node::Entry& e) { return e.key == last; });
}

void applyOverride(Node& root, const std::string& text) {
  if (text.starts_with('~')) return removeKey(root, text);
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(fmt::format("--set {}: the value is missing; write key=value, e.g. --set run.duration=2", text));
  const std::vector<std::string> parts = splitKey(std::string_view(text).substr(0, equals), text);
  Node* node = &root;
  for (const std::string& part : parts) {
    if (auto* list = std::get_if<Node::List>(&node->value)) {
      const bool isNumber = std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
      const auto named = std::find_if(list->begin(), list->end(), [&](const Node& entry) {
        const Node* name = entry.find("name");
        const auto* word = name ? std::get_if<std::string>(&name->value) : nullptr;
        return word && *word == part;
      });
      if (named != list->end()) {
        node = &*named;
        continue;
      }
      if (!isNumber || part.size() > 9 || std::stoul(part) >= list->size())
        throw InputError(fmt::format("--set {}: there is no entry {} in a list of {}; use an index from 0, or a name",
                                     text, part, list->size()));
      node = &(*list)[std::stoul(part)];
      continue;
    }
    if (!node->isMap())
      throw InputError(fmt::format("--set {}: the key before {} is a value, not a section", text, part));
    Node* child = node->find(part);
    if (!child) {
      auto& map = std::get<Node::Map>(node->value);
      map.push_back({part, Node{"--set", Node::Map{}}});
      child = &map.back().node;
    }
    node = child;
  }
  *node = overrideValue(text.substr(equals + 1), text);
}

void checkVersion(const Node& root, const std::string& name) {
  const Node* version = root.find("version");
  if (!version)
    throw InputError(fmt::format("{}:1: the key version is missing; begin the file with version = {}", name, kVersion));
  const auto* number = std::get_if<std::int64_t>(&version->value);
  if (!number || *number != kVersion)
    throw InputError(
        fmt::format("{}: unsupported version; this program reads version = {}", version->origin, kVersion));
}

} // namespace

Document Document::parse(std::string_view text, const std::string& name, const std::vector<std::string>& overrides) {
  Document document;
  document.root_ = parseToml(text, name);
  checkVersion(document.root_, name);
  for (const std::string& o : overrides) applyOverride(document.root_, o);
  checkVersion(document.root_, name);
  return document;
}

Document Document::load(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return parse(readInput(path, "check the path of the TOML file"), path.string(), overrides);
}

} // namespace grouser::base

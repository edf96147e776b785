// SPDX-License-Identifier: BSD-3-Clause
#include "base/table.hpp"

#include "base/name_fault.hpp"
#include "base/unknown_key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

namespace grouser::base {

namespace {

std::string number(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// Formats a bound in short decimal form: 0, 0.5, 1e+06.
std::string bound(double x) { return fmt::format("{:.6g}", x); }

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<int>(c));
    else
      out += c;
  }
  return escaped(out) + '"';
}

/// Text of a string for messages; long strings are abbreviated.
std::string shown(const std::string& text) {
  constexpr std::size_t kLongest = 300, kBegin = 40;
  const std::size_t length = characters(text);
  if (length <= kLongest) return quoted(text);
  std::size_t end = kBegin;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80) ++end; // inside a character
  return fmt::format("{}... ({} characters)", quoted(text.substr(0, end)), length);
}

template <class Range, class Format> std::string bracketed(const Range& range, Format format) {
  std::string out = "[";
  for (const auto& x : range) out += (out.size() > 1 ? ", " : "") + format(x);
  return out + "]";
}

template <class... Fs> struct Overloaded : Fs... { using Fs::operator()...; };
template <class... Fs> Overloaded(Fs...) -> Overloaded<Fs...>;

std::string typeText(FieldType type) {
  switch (type) {
  case FieldType::Boolean:
    return "true or false";
  case FieldType::Integer:
    return "a whole number";
  case FieldType::Real:
    return "a number";
  case FieldType::Text:
    return "a string in quotes";
  case FieldType::Pair:
    return "two numbers [a, b]";
  case FieldType::Vector:
    return "three numbers [x, y, z]";
  case FieldType::RealList:
    return "a list of numbers [a, b, ...]";
  case FieldType::TextList:
    return "a list of strings";
  case FieldType::BooleanPair:
    return "two booleans [true, false]";
  }
  return "";
}

/// Text of a node for messages; long lists are abbreviated.
std::string nodeText(const Node& node) {
  return std::visit(Overloaded{[](bool b) { return std::string(b ? "true" : "false"); },
                               [](std::int64_t i) { return fmt::format("{}", i); },
                               [](double x) { return fmt::format("{}", x); },
                               [](const std::string& s) { return shown(s); },
                               [](const Node::List& list) {
                                 if (list.size() > 4) return fmt::format("a list of {} entries", list.size());
                                 return bracketed(list, nodeText);
                               },
                               [](const Node::Map&) { return std::string("a table"); }},
                    node.value);
}

std::string unitText(const Field& field) { return field.unit.empty() ? "" : " [" + field.unit + "]"; }

[[noreturn]] void failType(const Node& node, const Field& field, const std::string& fullKey) {
  std::string wanted = typeText(field.type);
  if (!field.autoWord.empty()) wanted += " or \"" + field.autoWord + "\"";
  throw InputError(fmt::format("{}: {} = {} has the wrong type; expected {}{} ({})", node.origin, fullKey,
                               nodeText(node), wanted, unitText(field), field.help));
}

double readReal(const Node& node, const Node& whole, const Field& field, const std::string& fullKey) {
  double x = 0;
  if (const auto* d = std::get_if<double>(&node.value))
    x = *d;
  else if (const auto* i = std::get_if<std::int64_t>(&node.value))
    x = static_cast<double>(*i);
  else
    failType(whole, field, fullKey);
  const bool low = field.minOpen ? !(x > field.min) : !(x >= field.min);
  const bool high = field.maxOpen ? !(x < field.max) : !(x <= field.max);
  if (!std::isfinite(x))
    throw InputError(fmt::format("{}: {} = {}{} is not finite; use a finite number", node.origin, fullKey,
                                 nodeText(whole), unitText(field)));
  if (low || high) {
    const std::string slip = field.hasUsualSpan() ? field.unitSlip(x) : "";
    throw InputError(fmt::format("{}: {} = {}{} is outside {}; {}choose a value in that range ({})", node.origin,
                                 fullKey, nodeText(whole), unitText(field), field.rangeText(),
                                 slip.empty() ? "" : slip + "; ", field.help));
  }
  return x;
}

const Node::List& readList(const Node& node, std::size_t count, const Field& field, const std::string& fullKey) {
  const auto* list = std::get_if<Node::List>(&node.value);
  if (!list || (count && list->size() != count)) failType(node, field, fullKey);
  return *list;
}

std::string readText(const Node& node, const Field& field, const std::string& fullKey) {
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text) failType(node, field, fullKey);
  if (!field.choices.empty() && std::find(field.choices.begin(), field.choices.end(), *text) == field.choices.end())
    throw InputError(fmt::format("{}: {} = {} is not one of {}; did you mean \"{}\"? ({})", node.origin, fullKey,
                                 quoted(*text), fmt::join(field.choices, ", "), nearestWord(*text, field.choices),
                                 field.help));
  return *text;
}

bool readSwitch(const Node& node, const Node& whole, const Field& field, const std::string& fullKey) {
  const auto* b = std::get_if<bool>(&node.value);
  if (!b) failType(whole, field, fullKey);
  return *b;
}

} // namespace

std::string Field::rangeText() const {
  if (!choices.empty()) return fmt::format("one of {}", fmt::join(choices, ", "));
  if (!std::isfinite(min) && !std::isfinite(max)) return "";
  return fmt::format("{}{}, {}{}", minOpen || !std::isfinite(min) ? "(" : "[", bound(min), bound(max),
                     maxOpen || !std::isfinite(max) ? ")" : "]");
}

std::string toToml(const FieldValue& value) {
  return std::visit(Overloaded{[](std::monostate) { return std::string(); },
                               [](bool b) { return std::string(b ? "true" : "false"); },
                               [](std::int64_t i) { return fmt::format("{}", i); }, [](double x) { return number(x); },
                               [](const std::string& s) { return quoted(s); },
                               [](const std::array<double, 2>& a) { return bracketed(a, number); },
                               [](const Vec3d& v) {
                                 return bracketed(std::array{v.x, v.y, v.z}, number);
                               },
                               [](const std::vector<double>& v) { return bracketed(v, number); },
                               [](const std::vector<std::string>& v) { return bracketed(v, quoted); },
                               [](const std::array<bool, 2>& a) {
                                 return bracketed(a, [](bool b) { return std::string(b ? "true" : "false"); });
                               }},
                    value);
}

const Node* Node::find(std::string_view key) const {
  const auto* map = std::get_if<Map>(&value);
  if (!map) return nullptr;
  for (const Entry& e : *map)
    if (e.key == key) return &e.node;
  return nullptr;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

namespace detail {

FieldValue readValue(const Node& node, const Field& field, const std::string& fullKey) {
  if (!field.autoWord.empty())
    if (const auto* word = std::get_if<std::string>(&node.value); word && *word == field.autoWord) return {};
  const auto real = [&](const Node& n) { return readReal(n, node, field, fullKey); };
  switch (field.type) {
  case FieldType::Boolean:
    return readSwitch(node, node, field, fullKey);
  case FieldType::Integer:
    if (!std::holds_alternative<std::int64_t>(node.value)) failType(node, field, fullKey);
    real(node);
    return std::get<std::int64_t>(node.value);
  case FieldType::Real:
    return real(node);
  case FieldType::Text:
    return readText(node, field, fullKey);
  case FieldType::Pair: {
    const Node::List& list = readList(node, 2, field, fullKey);
    return std::array{real(list[0]), real(list[1])};
  }
  case FieldType::Vector: {
    const Node::List& list = readList(node, 3, field, fullKey);
    return Vec3d{real(list[0]), real(list[1]), real(list[2])};
  }
  case FieldType::RealList: {
    std::vector<double> values;
    for (const Node& n : readList(node, 0, field, fullKey)) values.push_back(real(n));
    return values;
  }
  case FieldType::TextList: {
    std::vector<std::string> values;
    for (const Node& n : readList(node, 0, field, fullKey)) values.push_back(readText(n, field, fullKey));
    return values;
  }
  case FieldType::BooleanPair: {
    const Node::List& list = readList(node, 2, field, fullKey);
    return std::array{readSwitch(list[0], node, field, fullKey), readSwitch(list[1], node, field, fullKey)};
  }
  }
  return {};
}

bool isEmpty(const FieldValue& value) {
  return std::visit(
      Overloaded{[](const std::string& s) { return s.empty(); }, [](const std::vector<double>& v) { return v.empty(); },
                 [](const std::vector<std::string>& v) { return v.empty(); }, [](const auto&) { return false; }},
      value);
}

void failMissing(const Node& section, const Field& field, const std::string& path) {
  const std::string range = field.rangeText();
  throw InputError(fmt::format("{}: {} lacks the required key {}{}; add {} = {}{} ({})", section.origin,
                               path.empty() ? "the file" : "[" + path + "]", field.key, unitText(field), field.key,
                               typeText(field.type), range.empty() ? "" : ", " + range, field.help));
}

/// True if at least a third of the letters agree; with fewer, a suggestion would be misleading.
bool resembles(const std::string& word, const std::string& other) {
  return 3 * editDistance(word, other) <= 2 * static_cast<int>(std::max(word.size(), other.size()));
}

void checkKeys(const Node& section, const std::string& path, const std::vector<std::string>& valid) {
  const auto* map = std::get_if<Node::Map>(&section.value);
  if (!map)
    throw InputError(fmt::format("{}: {} = {} has the wrong type; make it a table: [{}]", section.origin, path,
                                 nodeText(section), path));
  for (const Node::Entry& e : *map) {
    if (std::find(valid.begin(), valid.end(), e.key) != valid.end()) continue;
    std::vector<std::string> inner;
    if (const auto* entries = std::get_if<Node::Map>(&e.node.value))
      for (const Node::Entry& k : *entries) inner.push_back(k.key);
    if (inner.empty() && (e.node.isMap() || (e.node.isList() && path.empty()))) inner.emplace_back();
    const std::string nearest = nearestWord(e.key, valid);
    throw UnknownKey({e.node.origin, path, e.key, inner, valid}, resembles(e.key, nearest) ? nearest : "");
  }
}

} // namespace detail

Section Section::section(const std::string& key) const {
  const std::string full = path_.empty() ? key : path_ + "." + key;
  const Node* node = node_->find(key);
  if (!node) throw InputError(fmt::format("{}: the section [{}] is missing; add it", origin(), full));
  if (!node->isMap())
    throw InputError(fmt::format("{}: {} = {} has the wrong type; make it a table: [{}]", node->origin, full,
                                 nodeText(*node), full));
  return {*node, full, unusual_};
}

FieldValue Section::value(const Field& field) const {
  const Node* node = node_->find(field.key);
  if (!node) return {};
  return detail::readValue(*node, field, path_.empty() ? field.key : path_ + "." + field.key);
}

std::vector<std::pair<std::string, Section>> Section::named(const std::string& key) const {
  std::vector<std::pair<std::string, Section>> sections;
  if (!has(key)) return sections;
  const Section parent = section(key);
  for (const Node::Entry& e : std::get<Node::Map>(parent.node().value)) {
    const bool bare = std::all_of(e.key.begin(), e.key.end(),
                                  [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
    const std::string full = parent.path() + "." + (bare ? e.key : quoted(e.key));
    if (!e.node.isMap())
      throw InputError(fmt::format("{}: {} = {} is not a section; use [{}.NAME]", e.node.origin, full, nodeText(e.node),
                                   parent.path()));
    sections.emplace_back(e.key, Section(e.node, full, unusual_));
  }
  return sections;
}

std::vector<Section> Section::list(const std::string& key) const {
  std::vector<Section> sections;
  const Node* node = node_->find(key);
  if (!node) return sections;
  const std::string full = path_.empty() ? key : path_ + "." + key;
  const auto* list = std::get_if<Node::List>(&node->value);
  // If only --set defines keys, the file has no such section; the user may have meant another section.
  if (const auto* map = std::get_if<Node::Map>(&node->value); map && node->origin == "--set" && !map->empty())
    throw UnknownKey({node->origin, full, map->front().key, {}, {}}, "");
  if (!list || !std::all_of(list->begin(), list->end(), [](const Node& n) { return n.isMap(); }))
    throw InputError(fmt::format("{}: {} has the wrong type; make it a list of sections, each under [[{}]]",
                                 node->origin, full, full));
  for (std::size_t i = 0; i < list->size(); ++i)
    sections.emplace_back((*list)[i], fmt::format("{}.{}", full, i), unusual_);
  return sections;
}

void Section::noteIfUnusual(const std::string& key, const Field& field, const std::string& name) const {
  const Node* node = field.hasUsualSpan() && unusual_ ? node_->find(key) : nullptr;
  if (!node) return;
  double value = 0; // component of the largest magnitude
  const auto take = [&value](double x) { value = std::fabs(x) > std::fabs(value) ? x : value; };
  std::visit(Overloaded{[&](double x) { take(x); },
                        [&](const std::array<double, 2>& a) { std::for_each(a.begin(), a.end(), take); },
                        [&](const Vec3d& v) { take(v.x), take(v.y), take(v.z); },
                        [&](const std::vector<double>& v) { std::for_each(v.begin(), v.end(), take); },
                        [](const auto&) {}},
             detail::readValue(*node, field, key));
  if (const std::string text = field.unusualText(value); !text.empty())
    keep({name, unitText(field).empty() ? "" : fmt::format("{} {}", nodeText(*node), field.unit),
          fmt::format("{}: {} = {}{} {}", node->origin, name, nodeText(*node), unitText(field), text)});
}

void Section::noteUnusual(const std::vector<Field>& fields) const {
  for (const Field& field : fields)
    noteIfUnusual(field.key, field, path_.empty() ? field.key : path_ + "." + field.key);
}

std::string Section::described(const std::string& key, const std::string& message) const {
  const std::string full = path_.empty() ? key : key.empty() ? path_ : path_ + "." + key;
  const Node* node = node_->find(key);
  if (!node || node->isMap()) return fmt::format("{}: {} {}", node ? node->origin : origin(), full, message);
  return fmt::format("{}: {} = {} {}", node->origin, full, nodeText(*node), message);
}

void Section::keep(const UnusualValue& unusual) const {
  if (unusual_ && std::find(unusual_->begin(), unusual_->end(), unusual) == unusual_->end())
    unusual_->push_back(unusual);
}

void Section::fail(const std::string& key, const std::string& message) const {
  throw InputError(described(key, message));
}

void Section::note(const std::string& key, const std::string& message) const {
  keep({path_.empty() ? key : path_ + "." + key, "", described(key, message)});
}

int editDistance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int cost = lower(a[i - 1]) != lower(b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + cost});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

namespace {

/// True if `word` is `whole` with letters omitted.
bool isAbridged(std::string_view word, std::string_view whole) {
  std::size_t at = 0;
  for (const char c : whole) at += at < word.size() && word[at] == c;
  return at == word.size();
}

} // namespace

std::string nearestWord(std::string_view word, const std::vector<std::string>& valid) {
  std::string best;
  int least = std::numeric_limits<int>::max();
  for (const std::string& candidate : valid) {
    // Among equally near words, prefer one from which letters were omitted: "drivr" is driver, not drive.
    const int d = 2 * editDistance(word, candidate) - (isAbridged(word, candidate) ? 1 : 0);
    if (d < least) least = d, best = candidate;
  }
  return best;
}

namespace {

/// Wraps `text` to lines of at most 120 columns. No line begins with "+" or "-", which Markdown would show as a list.
std::string wrapped(const std::string& text) {
  std::string lines, line;
  std::istringstream words(text);
  for (std::string word, sign; words >> word;) {
    while ((words >> std::ws).peek() == '+' || words.peek() == '-') words >> sign, word += ' ' + sign;
    if (!line.empty() && line.size() + 1 + word.size() > 120) lines += line + '\n', line.clear();
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + line;
}

/// "(0, 60]; usually 4 to 50"
std::string rangeCell(const Field& field) {
  const std::string range = field.rangeText(), usual = field.usualText();
  return range + (range.empty() || usual.empty() ? "" : "; ") + (usual.empty() ? "" : "usually " + usual);
}

} // namespace

std::string describeFields(const std::string& name, const std::string& help, const std::vector<Field>& fields,
                           const std::vector<FieldValue>& defaults) {
  std::string text =
      fmt::format("### `[{}]`\n\n{}\n\n| key | unit | default | range | description |\n|---|---|---|---|---|\n", name,
                  wrapped(help + "."));
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Field& f = fields[i];
    std::string fallback = toToml(defaults[i]);
    if (f.isRequired)
      fallback = "required";
    else if (fallback.empty() && !f.autoWord.empty())
      fallback = quoted(f.autoWord);
    else if (fallback.empty() || fallback == "\"\"")
      fallback = "none";
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", f.key, f.unit, fallback, rangeCell(f), f.help);
  }
  return text;
}

} // namespace grouser::base

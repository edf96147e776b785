// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "base/error.hpp"
#include "base/vec.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// Strict reader of TOML files, based on one table of fields for each section.
///
/// A section is a plain struct. Its `Table` lists every key once, with unit, range and help, bound to a member of the
/// struct, and is used for parsing, checks, help text and resolved copy:
///
///     struct Wheel { double radius = 0.2; std::string material; };
///     base::Table<Wheel> wheelTable() {
///       base::Table<Wheel> t("wheel", "One road wheel");
///       t.add("radius", &Wheel::radius, "m", "rolling radius").above(0).atMost(10);
///       t.add("material", &Wheel::material, "", "name of its material").required();
///       return t;
///     }
///     const base::Document doc = base::Document::load("wheel.toml", {});
///     const Wheel wheel = doc.root().section("wheel").read(wheelTable());
namespace grouser::base {

/// Value of a field. `monostate`: an unset optional field.
using FieldValue = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::array<double, 2>, Vec3d,
                                std::vector<double>, std::vector<std::string>, std::array<bool, 2>>;

/// Type of a field in the file. Integers are accepted as reals, but reals not as integers.
enum class FieldType { Boolean, Integer, Real, Text, Pair, Vector, RealList, TextList, BooleanPair };

/// Description of a field, without its storage. Setters return the field, so calls can be chained.
struct Field {
  std::string key;
  std::string unit; ///< without brackets; empty for text and switches, "-" for a dimensionless number
  std::string help; ///< a short phrase
  FieldType type{};
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool minOpen = false, maxOpen = false;
  bool isRequired = false;
  std::string autoWord;                ///< word that means "not set", e.g. "auto"
  std::vector<std::string> formerKeys; ///< accepted for one version; read by Document::renameKeys
  std::vector<std::string> choices;    ///< words of an enum; empty: any text
  double usualMin = 0;                 ///< usual span of the magnitude, see plausible()
  double usualMax = std::numeric_limits<double>::infinity();
  std::string slip; ///< likely mistake outside the usual span, besides another unit

  Field& above(double a) { return min = a, minOpen = true, *this; }
  Field& atLeast(double a) { return min = a, minOpen = false, *this; }
  Field& below(double b) { return max = b, maxOpen = true, *this; }
  Field& atMost(double b) { return max = b, maxOpen = false, *this; }
  Field& required() { return isRequired = true, *this; }
  /// Permits `word` instead of a value; the member must be a `std::optional` and is then empty.
  Field& orWord(std::string word) { return autoWord = std::move(word), *this; }

  /// Usual span of the magnitude; for vectors and lists, of the largest component. A value outside it (except 0) is
  /// accepted with a note, which names the unit in which the value would be usual, or else `mistake`.
  Field& plausible(double least, double greatest, std::string mistake = "") {
    return usualMin = least, usualMax = greatest, slip = std::move(mistake), *this;
  }
  bool hasUsualSpan() const { return usualMin > 0 || usualMax < std::numeric_limits<double>::infinity(); }

  Field& formerly(std::string former) { return formerKeys.push_back(std::move(former)), *this; }

  /// Allowed range for messages: "(0, 10]", "one of cpu, cuda", or "" if unrestricted.
  std::string rangeText() const;
  /// Usual span for messages and help: "4 to 50", "at most 100", or "".
  std::string usualText() const;
  /// "is outside the usual span, 4 to 50 deg; in radians? 0.54 rad = 30.94 deg"; empty for a usual value.
  std::string unusualText(double value) const;
  /// "in radians? 0.54 rad = 30.94 deg": the unit in which `value` would be allowed and usual, else empty.
  std::string unitSlip(double value) const;
};

/// Former and current name of a renamed key.
struct FormerKey {
  std::string former, now;
};

/// Returns the value as TOML text; a real always has a decimal point ("1.0") and round-trips to the same bits.
std::string toToml(const FieldValue& value);

/// Value of a parsed file with its source location.
struct Node {
  using List = std::vector<Node>;
  struct Entry;
  using Map = std::vector<Entry>; ///< entries in the file's order

  std::string origin; ///< "scene.toml:14", or "--set" for an override
  std::variant<bool, std::int64_t, double, std::string, List, Map> value;

  bool isMap() const { return std::holds_alternative<Map>(value); }
  bool isList() const { return std::holds_alternative<List>(value); }
  const Node* find(std::string_view key) const; ///< null if this is not a table or the key is absent
  Node* find(std::string_view key);
};
struct Node::Entry {
  std::string key;
  Node node;
};

namespace detail {
FieldValue readValue(const Node& node, const Field& field, const std::string& fullKey);
[[noreturn]] void failMissing(const Node& section, const Field& field, const std::string& path);
bool isEmpty(const FieldValue& value); ///< true for an empty text or list
void checkKeys(const Node& section, const std::string& path, const std::vector<std::string>& valid);

template <class T> struct FieldTypeOf;
template <> struct FieldTypeOf<bool> {
  static constexpr FieldType type = FieldType::Boolean;
  using Stored = bool;
};
template <> struct FieldTypeOf<int> {
  static constexpr FieldType type = FieldType::Integer;
  using Stored = std::int64_t;
};
template <> struct FieldTypeOf<std::int64_t> {
  static constexpr FieldType type = FieldType::Integer;
  using Stored = std::int64_t;
};
template <> struct FieldTypeOf<double> {
  static constexpr FieldType type = FieldType::Real;
  using Stored = double;
};
template <> struct FieldTypeOf<std::string> {
  static constexpr FieldType type = FieldType::Text;
  using Stored = std::string;
};
template <> struct FieldTypeOf<std::array<double, 2>> {
  static constexpr FieldType type = FieldType::Pair;
  using Stored = std::array<double, 2>;
};
template <> struct FieldTypeOf<Vec3d> {
  static constexpr FieldType type = FieldType::Vector;
  using Stored = Vec3d;
};
template <> struct FieldTypeOf<std::vector<double>> {
  static constexpr FieldType type = FieldType::RealList;
  using Stored = std::vector<double>;
};
template <> struct FieldTypeOf<std::vector<std::string>> {
  static constexpr FieldType type = FieldType::TextList;
  using Stored = std::vector<std::string>;
};
template <> struct FieldTypeOf<std::array<bool, 2>> {
  static constexpr FieldType type = FieldType::BooleanPair;
  using Stored = std::array<bool, 2>;
};
template <HasWords E> struct FieldTypeOf<E> : FieldTypeOf<std::string> {};
template <HasWords E> struct FieldTypeOf<std::vector<E>> : FieldTypeOf<std::vector<std::string>> {};
template <class T> struct FieldTypeOf<std::optional<T>> : FieldTypeOf<T> {};

/// Enum type of a member that is an enum, a list of enums or an optional enum; void if the type has no words.
template <class T> struct EnumOf { using Type = void; };
template <HasWords E> struct EnumOf<E> { using Type = E; };
template <class T> struct EnumOf<std::vector<T>> : EnumOf<T> {};
template <class T> struct EnumOf<std::optional<T>> : EnumOf<T> {};

/// Converts between a member and its FieldValue. Words must be valid words of the enum.
template <class T> struct Conversion {
  using Stored = typename FieldTypeOf<T>::Stored;
  static FieldValue toField(const T& member) { return static_cast<Stored>(member); }
  static T fromField(const FieldValue& value) { return static_cast<T>(std::get<Stored>(value)); }
};
template <HasWords E> struct Conversion<E> {
  static FieldValue toField(E member) { return std::string(wordOf(member)); }
  static E fromField(const FieldValue& value) { return *valueOf<E>(std::get<std::string>(value)); }
};
template <HasWords E> struct Conversion<std::vector<E>> {
  static FieldValue toField(const std::vector<E>& members) {
    std::vector<std::string> words;
    for (const E e : members) words.emplace_back(wordOf(e));
    return words;
  }
  static std::vector<E> fromField(const FieldValue& value) {
    std::vector<E> members;
    for (const std::string& word : std::get<std::vector<std::string>>(value)) members.push_back(*valueOf<E>(word));
    return members;
  }
};
template <class T> struct Conversion<std::optional<T>> {
  static FieldValue toField(const std::optional<T>& member) {
    return member ? Conversion<T>::toField(*member) : FieldValue{};
  }
  static std::optional<T> fromField(const FieldValue& value) { return Conversion<T>::fromField(value); }
};
} // namespace detail

/// Fields of one section, bound to the members of `S`. Defaults are the values of a default-constructed `S`. Types:
/// bool, int, int64, double, string, array<double, 2>, Vec3d, vector<double>, vector<string>, array<bool, 2>, an enum
/// with words or a vector of it, or an optional of these (empty: not set).
template <class S> class Table {
public:
  /// `name` as written in a file ("run", "material.NAME"), and one sentence of help.
  Table(std::string name, std::string help) : name_(std::move(name)), help_(std::move(help)) {}

  template <class T, class Owner> // S, or a base of it
  Field& add(std::string key, T Owner::*member, std::string unit, std::string help) {
    auto set = [member](S& s, const FieldValue& v) {
      s.*member = std::holds_alternative<std::monostate>(v) ? T{} : detail::Conversion<T>::fromField(v);
    };
    auto get = [member](const S& s) { return detail::Conversion<T>::toField(s.*member); };
    Field field;
    field.key = std::move(key), field.unit = std::move(unit), field.help = std::move(help);
    field.type = detail::FieldTypeOf<T>::type;
    using Enum = typename detail::EnumOf<T>::Type;
    if constexpr (!std::is_void_v<Enum>) field.choices = wordsOf<Enum>();
    entries_.push_back({std::move(field), std::move(set), std::move(get)});
    return entries_.back().field;
  }

  const std::string& name() const { return name_; }
  const std::string& help() const { return help_; }
  std::vector<Field> fields() const {
    std::vector<Field> list;
    for (const Entry& e : entries_) list.push_back(e.field);
    return list;
  }
  std::vector<FormerKey> formerKeys() const {
    std::vector<FormerKey> list;
    for (const Entry& e : entries_)
      for (const std::string& former : e.field.formerKeys) list.push_back({former, e.field.key});
    return list;
  }
  FieldValue value(const S& s, std::string_view key) const {
    for (const Entry& e : entries_)
      if (e.field.key == key) return e.get(s);
    return {};
  }

  /// Reads `section` into `s`, which contains the defaults. `path` is the section's full name for messages;
  /// `subsections` lists keys read elsewhere. Throws InputError for a key that is unknown or missing, or has a value of
  /// the wrong type or out of range.
  void read(const Node& section, const std::string& path, S& s,
            const std::vector<std::string>& subsections = {}) const {
    std::vector<std::string> valid = subsections;
    for (const Entry& e : entries_) valid.push_back(e.field.key);
    detail::checkKeys(section, path, valid);
    for (const Entry& e : entries_) {
      const Node* node = section.find(e.field.key);
      if (node)
        e.set(s, detail::readValue(*node, e.field, path.empty() ? e.field.key : path + "." + e.field.key));
      else if (e.field.isRequired)
        detail::failMissing(section, e.field, path);
    }
  }

  /// Omits empty texts and lists when sections are written.
  Table& leaveOutEmpty() { return leavesOutEmpty_ = true, *this; }

  /// Returns a `key = value` line for every field that is set, in the table's order.
  std::string write(const S& s) const {
    std::string text;
    for (const Entry& e : entries_) {
      const FieldValue v = e.get(s);
      if (leavesOutEmpty_ && detail::isEmpty(v)) continue;
      if (!std::holds_alternative<std::monostate>(v))
        text += e.field.key + " = " + toToml(v) + "\n";
      else if (!e.field.autoWord.empty())
        text += e.field.key + " = \"" + e.field.autoWord + "\"\n";
    }
    return text;
  }

private:
  struct Entry {
    Field field;
    std::function<void(S&, const FieldValue&)> set;
    std::function<FieldValue(const S&)> get;
  };
  std::string name_, help_;
  std::vector<Entry> entries_;
  bool leavesOutEmpty_ = false;
};

/// A value outside the usual span of its field.
struct UnusualValue {
  std::string key;   ///< "scm.K"
  std::string value; ///< "0.4 m", as other errors quote it; empty without a unit
  std::string note;  ///< one line with location and likely unit
  bool operator==(const UnusualValue&) const = default;
};

/// A view of one table of a file.
class Section {
public:
  /// `unusual` collects the unusual values that read() finds; null: it does not look for them.
  Section(const Node& node, std::string path, std::vector<UnusualValue>* unusual = nullptr)
      : node_(&node), path_(std::move(path)), unusual_(unusual) {}

  const Node& node() const { return *node_; }
  const std::string& path() const { return path_; }           ///< "material.soil"; empty at the root
  const std::string& origin() const { return node_->origin; } ///< "scene.toml:14"
  std::string name() const { return path_.substr(path_.rfind('.') + 1); }

  bool has(std::string_view key) const { return node_->find(key) != nullptr; }
  /// Returns the value of a field's key with the same checks as read(); empty if the key is absent. Throws InputError
  /// for a wrong type or a value out of range.
  FieldValue value(const Field& field) const;
  /// Returns the table `key`. Throws InputError if it is missing or not a table.
  Section section(const std::string& key) const;
  /// Returns the tables under `key` with their names, in file order: [material.soil], [material.steel]. Empty if there
  /// are none.
  std::vector<std::pair<std::string, Section>> named(const std::string& key) const;
  /// Returns the elements of `[[key]]`; empty if there are none.
  std::vector<Section> list(const std::string& key) const;

  /// Reads the section over the defaults of `S`.
  template <class S>
  S read(const Table<S>& table, S defaults = {}, const std::vector<std::string>& subsections = {}) const {
    table.read(*node_, path_, defaults, subsections);
    if (unusual_) noteUnusual(table.fields());
    return defaults;
  }

  /// Throws InputError for a key not in `valid`; the message names the nearest valid key.
  void allowOnly(const std::vector<std::string>& valid) const { detail::checkKeys(*node_, path_, valid); }

  /// Throws InputError "file:line: path.key = value <message>", with the line of the key, or of the section if the key
  /// is absent.
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;
  /// Adds a note with the same text to Document::unusual().
  void note(const std::string& key, const std::string& message) const;
  /// Adds a note if the value of `key` is outside the usual span of `field`; `name`: its name in the note.
  void noteIfUnusual(const std::string& key, const Field& field, const std::string& name) const;

private:
  void noteUnusual(const std::vector<Field>& fields) const;
  std::string described(const std::string& key, const std::string& message) const;
  void keep(const UnusualValue& unusual) const;

  const Node* node_;
  std::string path_;
  std::vector<UnusualValue>* unusual_;
};

/// Parsed TOML file with overrides applied. The file must contain `version = 1`.
class Document {
public:
  /// Reads the file. Each override is "a.b.c=value", e.g. `grain.0.radius=0.01`, `contact."a|b".friction=0.3` or
  /// `body."left wheel".mass=2` (list entry named "left wheel"); the value is TOML or a bare word, read as text.
  /// "~a.b.c" removes a key or section. Throws InputError for a missing file, invalid syntax (file:line:column), an
  /// unsupported version, or an invalid override.
  static Document load(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});
  /// Parses text instead of a file; `name` is the file name for messages.
  static Document parse(std::string_view text, const std::string& name, const std::vector<std::string>& overrides = {});

  /// Renames former keys of a file to their current names; call it before any section is read. `where`: section path,
  /// "run", or "grain" for every entry of that list; a trailing ".*" selects all subsections: "material.*". Throws
  /// InputError if the file has both names.
  void renameKeys(const std::string& where, const std::vector<FormerKey>& keys);
  /// Sets `key` = `text` in the table `section.name` if the key is absent, with `origin` as its location in messages.
  /// Adds the table if missing. Throws InputError if a parent of the key is not a table.
  void supply(const std::string& section, const std::string& name, const std::string& key, const std::string& text,
              const std::string& origin);
  /// Sets `section.key` to `value`, also if already set; adds the section if missing. Throws InputError if `section` is
  /// not a table.
  void put(const std::string& section, const std::string& key, const Node& value);
  /// One line per renamed key, with its location and the required change to the file.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Values outside the usual spans of their fields, for all sections that have been read.
  const std::vector<UnusualValue>& unusual() const { return unusual_; }

  /// Root section, valid as long as the document exists. Sections may be read with `version` among their subsections.
  Section root() const& { return {root_, "", &unusual_}; }
  Section root() const&& = delete;

private:
  Node root_;
  std::vector<std::string> notes_;
  mutable std::vector<UnusualValue> unusual_; // filled while sections are read
};

/// Number of edits (insert, delete, replace, swap of neighbours; case ignored) between two words.
int editDistance(std::string_view a, std::string_view b);
/// Returns the word of `valid` nearest to `word`; empty if `valid` is empty.
std::string nearestWord(std::string_view word, const std::vector<std::string>& valid);

/// Returns a Markdown table "key | unit | default | range | help" under a heading with the table's name and help.
std::string describeFields(const std::string& name, const std::string& help, const std::vector<Field>& fields,
                           const std::vector<FieldValue>& defaults);
template <class S> std::string describe(const Table<S>& table) {
  const std::vector<Field> fields = table.fields();
  std::vector<FieldValue> defaults;
  for (const Field& f : fields) defaults.push_back(table.value(S{}, f.key));
  return describeFields(table.name(), table.help(), fields, defaults);
}

} // namespace grouser::base

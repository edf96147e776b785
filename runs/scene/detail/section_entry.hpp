// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// Sections of a scene file: reading, checks, the resolved copy and the help iterate over one list of entries. The
/// functions below make entries for single, optional, listed and named sections. `where` selects the data of the
/// section: a member of Scene, or a function that returns a reference into a Scene.
namespace grouser::scene::detail {

struct SectionEntry {
  std::string name; ///< in a file, without brackets; may be a subsection, "driver.table"
  std::function<void(const base::Section& root, Scene& scene)> read; ///< reads and checks; throws InputError
  std::function<std::string(const Scene& scene)> write;              ///< TOML with headings
  std::function<std::string()> describe;                             ///< Markdown
  std::function<void(base::Document& document)> renameKeys;          ///< renames keys with a former name
  std::vector<std::string> keys;                                     ///< full names: "driver.table.time"

  /// Writes the section only for scenes for which `holds` returns true.
  SectionEntry writtenIf(bool (*holds)(const Scene&)) && {
    write = [holds, always = std::move(write)](const Scene& s) { return holds(s) ? always(s) : std::string(); };
    return std::move(*this);
  }
};
using SectionList = std::vector<SectionEntry>;

/// Checks that a table cannot express, and defaults that follow from other keys. `scene` contains all sections that
/// precede this one in the list of entries.
template <class S> using Check = std::function<void(const base::Section& section, S& s, const Scene& scene)>;
template <class S> using CheckOf = std::type_identity_t<Check<S>>; // not deduced

template <class S> std::vector<std::string> fullKeys(const std::string& name, const base::Table<S>& table) {
  std::vector<std::string> keys;
  for (const base::Field& field : table.fields()) keys.push_back(name + "." + field.key);
  return keys;
}

/// The section at a path such as "driver.table"; empty if there is none.
inline std::optional<base::Section> findSection(const base::Section& root, const std::string& path) {
  const std::size_t dot = path.find('.');
  const std::string first = path.substr(0, dot);
  if (!root.has(first)) return {};
  const base::Section section = root.section(first);
  return dot == std::string::npos ? section : findSection(section, path.substr(dot + 1));
}

template <class S> S readChecked(const base::Section& section, const base::Table<S>& table, const Check<S>& check,
                                 const Scene& scene, const std::vector<std::string>& subsections = {},
                                 S defaults = {}) {
  S s = section.read(table, std::move(defaults), subsections);
  if (check) check(section, s, scene);
  return s;
}

template <class S> std::string written(const std::string& heading, const base::Table<S>& table, const S& s) {
  return fmt::format("\n{}\n{}", heading, table.write(s));
}

template <class S, class Where>
std::function<void(const base::Section&, Scene&)> readerOfOne(const std::string& name, Where where,
                                                              const base::Table<S>& table, const Check<S>& check,
                                                              const std::vector<std::string>& subsections = {}) {
  return [=](const base::Section& root, Scene& scene) {
    if (const auto section = findSection(root, name))
      std::invoke(where, scene) = readChecked<S>(*section, table, check, scene, subsections);
  };
}

/// Single section [name], with defaults if the file does not contain it. `subsections` have their own entries.
template <class S, class Where> SectionEntry single(const std::string& name, Where where, const base::Table<S>& table,
                                                    CheckOf<S> check = {},
                                                    const std::vector<std::string>& subsections = {}) {
  return {name,
          readerOfOne<S>(name, where, table, check, subsections),
          [=](const Scene& scene) { return written<S>(fmt::format("[{}]", name), table, std::invoke(where, scene)); },
          [=] { return base::describe(table); },
          [=](base::Document& document) { document.renameKeys(name, table.formerKeys()); },
          fullKeys(name, table)};
}

/// Required section [name].
template <class S, class Where>
SectionEntry required(const std::string& name, Where where, const base::Table<S>& table, CheckOf<S> check = {}) {
  SectionEntry entry = single<S>(name, where, table, check);
  entry.read = [name, read = std::move(entry.read)](const base::Section& root, Scene& scene) {
    root.section(name); // throws if the section is missing
    read(root, scene);
  };
  return entry;
}

/// Optional section [name].
template <class S, class Where> SectionEntry optional(const std::string& name, Where where, const base::Table<S>& table,
                                                      CheckOf<S> check = {},
                                                      const std::vector<std::string>& subsections = {}) {
  return {name,
          readerOfOne<S>(name, where, table, check, subsections),
          [=](const Scene& scene) {
            const std::optional<S>& s = std::invoke(where, scene);
            return s ? written<S>(fmt::format("[{}]", name), table, *s) : std::string();
          },
          [=] { return base::describe(table); },
          [=](base::Document& document) { document.renameKeys(name, table.formerKeys()); },
          fullKeys(name, table)};
}

/// List of sections [[name]], in the order of the file.
template <class S, class Where>
SectionEntry list(const std::string& name, Where where, const base::Table<S>& table, CheckOf<S> check = {}) {
  return {name,
          [=](const base::Section& root, Scene& scene) {
            for (const base::Section& section : root.list(name))
              std::invoke(where, scene).push_back(readChecked<S>(section, table, check, scene));
          },
          [=](const Scene& scene) {
            std::string text;
            for (const S& s : std::invoke(where, scene)) text += written<S>(fmt::format("[[{}]]", name), table, s);
            return text;
          },
          [=] { return base::describe(table); },
          [=](base::Document& document) { document.renameKeys(name, table.formerKeys()); },
          fullKeys(name, table)};
}

/// Sections [name.KEY], in the order of the file. `begin` makes a section with its key and initial values, `keyOf`
/// returns the key.
template <class S, class Where>
SectionEntry named(const std::string& name, Where where, const base::Table<S>& table,
                   S (*begin)(const base::Section& section, const std::string& key, Scene& scene),
                   std::string (*keyOf)(const S&), CheckOf<S> check = {}) {
  return {name,
          [=](const base::Section& root, Scene& scene) {
            for (const auto& [key, section] : root.named(name))
              std::invoke(where, scene)
                  .push_back(readChecked<S>(section, table, check, scene, {}, begin(section, key, scene)));
          },
          [=](const Scene& scene) {
            std::string text;
            for (const S& s : std::invoke(where, scene)) // TOML allows quotes for all keys
              text += written<S>(fmt::format("[{}.{}]", name, base::toToml(keyOf(s))), table, s);
            return text;
          },
          [=] { return base::describe(table); },
          [=](base::Document& document) { document.renameKeys(name + ".*", table.formerKeys()); },
          fullKeys(name, table)};
}

} // namespace grouser::scene::detail

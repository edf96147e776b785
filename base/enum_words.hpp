// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace grouser::base {

/// Name of an enum value in files and on the command line.
template <class E> struct EnumWord {
  E value;
  std::string_view word;
};

/// Names of an enum's values, in the order of messages and help. Specialise this template for each enum that users
/// choose from; values without a name cannot be chosen:
///
///     template <> struct EnumWords<FloorShape> {
///       static constexpr EnumWord<FloorShape> list[] = {{FloorShape::follow, "follow"}, {FloorShape::flat, "flat"}};
///     };
template <class E> struct EnumWords;

template <class E>
concept HasWords = std::is_enum_v<E> && requires {
  EnumWords<E>::list;
};

/// Returns the word for `value`; empty if the value has no word.
template <HasWords E> constexpr std::string_view wordOf(E value) {
  for (const EnumWord<E>& e : EnumWords<E>::list)
    if (e.value == value) return e.word;
  return {};
}

/// Returns the value named by `word`; empty if `word` is not in the list.
template <HasWords E> constexpr std::optional<E> valueOf(std::string_view word) {
  for (const EnumWord<E>& e : EnumWords<E>::list)
    if (e.word == word) return e.value;
  return {};
}

template <HasWords E> std::vector<std::string> wordsOf() {
  std::vector<std::string> words;
  for (const EnumWord<E>& e : EnumWords<E>::list) words.emplace_back(e.word);
  return words;
}

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#include "base/name_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>

namespace grouser::base {

namespace {

/// Control characters, and invisible characters that change the text around them (Unicode categories Cc, Cf, Zl, Zp),
/// except the joiners U+200C and U+200D, which some scripts require.
constexpr std::pair<std::uint32_t, std::uint32_t> kInvisible[] = {
    {0x00, 0x1F},     {0x7F, 0x9F},     {0xAD, 0xAD},     {0x61C, 0x61C},   {0x180E, 0x180E}, {0x200B, 0x200B},
    {0x200E, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x206F}, {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFB}, {0xE0000, 0xE007F}};

struct Character {
  std::size_t bytes = 1;
  std::uint32_t code = 0;
  bool valid = false;
};

/// The UTF-8 character at `i`; one invalid byte if there is none.
Character characterAt(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const std::uint32_t first = byte(i);
  if (first < 0x80) return {1, first, true};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || i + bytes > text.size()) return {};
  std::uint32_t code = first & (0x7FU >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(i + k) & 0xC0U) != 0x80) return {};
    code = code << 6 | (byte(i + k) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000}; // shorter encodings exist below
  if (code < kLeast[bytes] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
  return {bytes, code, true};
}

bool isInvisible(const Character& c) {
  return !c.valid || std::any_of(std::begin(kInvisible), std::end(kInvisible),
                                 [&](const auto& range) { return c.code >= range.first && c.code <= range.second; });
}

} // namespace

bool hasControlCharacter(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const Character c = characterAt(text, i);
    if (isInvisible(c)) return true;
    i += c.bytes;
  }
  return false;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const Character c = characterAt(text, i);
    if (!isInvisible(c) || text[i] == '\n' || text[i] == '\t')
      out += text.substr(i, c.bytes);
    else if (!c.valid || c.code < 0x80)
      out += fmt::format("\\x{:02X}", static_cast<unsigned char>(text[i]));
    else
      out += c.code > 0xFFFF ? fmt::format("\\U{:08X}", c.code) : fmt::format("\\u{:04X}", c.code);
    i += c.bytes;
  }
  return out;
}

std::size_t characters(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); i += characterAt(text, i).bytes) ++count;
  return count;
}

std::string textFault(const std::string& text, std::size_t longest) {
  if (hasControlCharacter(text))
    return "contains a control character or an invisible one (line feed, escape, U+202E...), which results files do "
           "not support; remove it";
  if (text.find_first_of("<>") != std::string::npos)
    return "contains < or >, the brackets of HTML; use letters, digits, blanks and other characters except < and > "
           "and control characters";
  if (const std::size_t length = characters(text); length > longest)
    return fmt::format("has {} characters, more than {}; shorten it", length, longest);
  return "";
}

std::string nameFault(const std::string& name) {
  if (name.empty()) return "is an empty name; set a name";
  if (name.find('/') != std::string::npos)
    return "has a / in its name, which separates names in results files; remove it";
  return textFault(name, kLongestName);
}

} // namespace grouser::base

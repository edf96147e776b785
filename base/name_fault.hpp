// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

namespace grouser::base {

/// True if the UTF-8 text contains a control character (C0, DEL, C1) or a character that changes the direction or the
/// lines of the text around it (U+2028 to U+202E, U+2066 to U+2069).
inline bool hasControlCharacter(const std::string& text) {
  const auto isControl = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::any_of(text.begin(), text.end(), isControl)) return true;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const auto byte = [&](std::size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0; };
    if (byte(0) == 0xC2 && byte(1) <= 0x9F) return true;
    if (byte(0) == 0xE2 && byte(1) == 0x80 && byte(2) >= 0xA8 && byte(2) <= 0xAE) return true;
    if (byte(0) == 0xE2 && byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9) return true;
  }
  return false;
}

/// Error message for a user's text that pages and results files do not support: it contains a control character, < or
/// >. Empty for a valid text.
inline std::string textFault(const std::string& text) {
  if (hasControlCharacter(text))
    return "contains a control character (line feed, tab, escape...), which results files do not support; remove it";
  if (text.find_first_of("<>") != std::string::npos)
    return "contains < or >, the brackets of HTML; use letters, digits, blanks and other characters except < > and "
           "control characters";
  return "";
}

/// The same for a name, which also must not be empty or contain a slash (separator of HDF5 groups).
inline std::string nameFault(const std::string& name) {
  if (name.empty()) return "is an empty name; set a name";
  if (name.find('/') != std::string::npos)
    return "has a / in its name, which separates names in results files; remove it";
  return textFault(name);
}

} // namespace grouser::base

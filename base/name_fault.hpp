// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

/// Characters and lengths of names and texts of a user, which appear on terminals, in pages and in results files.
namespace grouser::base {

constexpr std::size_t kLongestName = 64;  ///< [characters] fits into file names, columns and legends
constexpr std::size_t kLongestText = 200; ///< [characters] fits above a plot

/// True if the text is not valid UTF-8, or contains a control character (C0, DEL, C1) or an invisible format character,
/// which changes the direction, the lines or the look of the text around it (U+202E, U+200B...).
bool hasControlCharacter(const std::string& text);

/// The text with these characters escaped, as \u202E; invalid bytes as \xFF. Line feeds and tabs remain.
std::string escaped(const std::string& text);

/// Number of characters of a UTF-8 text.
std::size_t characters(const std::string& text);

/// Error message for a user's text that pages and results files do not support: it contains a control character, < or
/// >, or is longer than `longest`. Empty for a valid text.
std::string textFault(const std::string& text, std::size_t longest = kLongestText);

/// The same for a name, which also must not be empty or contain a slash (separator of HDF5 groups).
std::string nameFault(const std::string& name);

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/shell_word.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace grouser::support {

std::string shellWord(const std::string& word) {
  const auto isPlain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_@%+=:,./-", c); };
  if (!word.empty() && std::all_of(word.begin(), word.end(), isPlain)) return word;
  std::string text(1, '\'');
  for (const char c : word)
    if (c == '\'')
      text += "'\\''";
    else
      text += c;
  text += '\'';
  return text;
}

std::string shellLine(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    line += shellWord(word);
  }
  return line;
}

} // namespace grouser::support

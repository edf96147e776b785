// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace grouser::support {

/// As a shell takes it for one word: in quotes where it holds more than letters, digits and _@%+=:,./-
std::string shellWord(const std::string& word);
/// A command as it can be given to a shell again.
std::string shellLine(const std::vector<std::string>& words);

} // namespace grouser::support

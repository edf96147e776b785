// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace grouser::support {

/// One word for a shell, quoted if it contains characters other than letters, digits and _@%+=:,./-
std::string shellWord(const std::string& word);
/// A command line for a shell.
std::string shellLine(const std::vector<std::string>& words);

} // namespace grouser::support

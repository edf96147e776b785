// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Overrides of scene keys from the command line: "key=value".
namespace grouser::sweeps {

/// Position of the "=" between key and value; skips any "=" in a quoted key. npos if missing.
std::size_t equalsSign(const std::string& set);

/// Key of an override without quotes: contact."a|b".friction and contact.a|b.friction are equal.
std::string keyOf(const std::string& set);

/// Throws InputError, with both values in the message, if two overrides set the same key.
void checkGivenOnce(const std::vector<std::string>& overrides);

/// Adds `set`, replacing overrides of the same key.
void putOverride(std::vector<std::string>& overrides, const std::string& set);

} // namespace grouser::sweeps

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Overrides of a scene's keys as a command line gives them: "key=value".
namespace grouser::sweeps {

/// Position of the = between key and value: a key in quotes may hold one. npos where there is none.
std::size_t equalsSign(const std::string& set);

/// The key, without quotes: contact."a|b".friction and contact.a|b.friction are one.
std::string keyOf(const std::string& set);

/// Throws InputError, with both values, where two of them set one key.
void checkGivenOnce(const std::vector<std::string>& overrides);

/// Adds `set`, which takes the place of those that set the same key.
void putOverride(std::vector<std::string>& overrides, const std::string& set);

} // namespace grouser::sweeps

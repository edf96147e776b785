// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/unknown_key.hpp"

#include <string>
#include <vector>

namespace grouser::base {

/// Returns the error with the nearest of all the file's keys ("section.key"): the message suggests another section if
/// the key belongs there or is nearer to one of its keys.
InputError amongAllKeys(const UnknownKey& unknown, const std::vector<std::string>& all);

} // namespace grouser::base

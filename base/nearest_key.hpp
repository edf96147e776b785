// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/unknown_key.hpp"

#include <string>
#include <vector>

namespace grouser::base {

/// Returns the error with the nearest of all keys of the file ("section.key"). The message suggests another section if
/// the key belongs to it or is nearer to one of its keys.
InputError amongAllKeys(const UnknownKey& unknown, const std::vector<std::string>& all);

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/unknown_key.hpp"

#include <string>
#include <vector>

namespace grouser::base {

/// The same error, given all keys of the file as "section.key": if the key belongs to another section, or is nearer to
/// one of its keys, the message names that.
InputError amongAllKeys(const UnknownKey& unknown, const std::vector<std::string>& all);

} // namespace grouser::base

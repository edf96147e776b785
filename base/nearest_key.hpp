// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/unknown_key.hpp"

#include <string>
#include <vector>

namespace grouser::base {

/// The same fault for a reader who knows all keys of the file, as "section.key": where the key is one of another
/// section, or is nearer to one, the message names that.
InputError amongAllKeys(const UnknownKey& unknown, const std::vector<std::string>& all);

} // namespace grouser::base

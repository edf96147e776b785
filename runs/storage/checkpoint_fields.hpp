// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/file_field.hpp"

#include <vector>

namespace grouser::storage {

/// All fields of checkpoint.h5 and cached beds. Throws std::logic_error for a field without a description, and for a
/// description without a field.
std::vector<support::FileField> checkpointFields();

} // namespace grouser::storage

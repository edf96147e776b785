// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/support/file_field.hpp"

#include <vector>

namespace grouser::storage {

/// All that checkpoint.h5 and a kept bed may hold. Throws std::logic_error for a field that nothing is said of, and for
/// a word on a field that is not stored.
std::vector<support::FileField> checkpointFields();

} // namespace grouser::storage

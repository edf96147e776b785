// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "base/parcel.hpp"

#include <span>

namespace grouser::base {

/// Executes up to four copies (parcels) asynchronously in one launch; on a GPU the kernel accesses host memory
/// directly. Throws std::logic_error if there are more parcels or a size is not a multiple of 8.
void carry(const Exec& exec, std::span<const Parcel> parcels);

} // namespace grouser::base

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "base/parcel.hpp"

#include <span>

namespace grouser::base {

/// Sets up to four parcels in one launch, without waiting: on a GPU a kernel reads and writes the host's memory itself.
/// Throws std::logic_error for more, or other sizes.
void carry(const Exec& exec, std::span<const Parcel> parcels);

} // namespace grouser::base

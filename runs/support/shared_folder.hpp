// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <filesystem>
#include <optional>

namespace grouser::support {

/// First rank that does not see files of rank 0 in this folder (local folders, or ranks started in different folders).
/// Empty if all ranks see them; 0 if rank 0 cannot write there. All ranks call it and get the same result; a failure
/// takes seconds. Leaves no files.
std::optional<int> rankNotSeeing(const std::filesystem::path& folder, const base::Comm& comm);

} // namespace grouser::support

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <filesystem>
#include <optional>

namespace grouser::support {

/// A rank that does not see what the first one writes in this folder: the folder lies on a disk of each host's own, or
/// the ranks were started in different places. None where all do; the first where it cannot write there at all. All
/// ranks call it and learn the same; it takes seconds where something is amiss. Leaves nothing behind.
std::optional<int> rankNotSeeing(const std::filesystem::path& folder, const base::Comm& comm);

} // namespace grouser::support

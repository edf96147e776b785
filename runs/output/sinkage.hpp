// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace grouser::output {

/// Writes sinkage.csv into `folder`: time and one column a shoe [m], NaN while the shoe is off the ground run.
/// Throws base::InputError where `results` is no results.h5 of a run with a vehicle. Returns the file's path.
std::filesystem::path writeSinkageCsv(const std::filesystem::path& results, const std::filesystem::path& folder);

} // namespace grouser::output

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"

namespace grouser::output {

/// Reads the first `count` rows of `folder`/results.h5, which a run resumed at `step` keeps. Does not modify it. Throws
/// base::InputError where the file cannot be read, or does not hold so many rows up to that step of these channels.
std::vector<Row> readRows(const std::filesystem::path& folder, const std::vector<Channel>& channels, std::int64_t step,
                          std::int64_t count);

/// Number of frames of `folder`/frames.h5 that a run resumed at `step` keeps, with `count` frames in its checkpoint:
/// these, and if `atEnd` also the final frame at `step` if the file has it. They stay in the file. Throws
/// base::InputError if they are missing.
std::int64_t keptFrames(const std::filesystem::path& folder, std::int64_t step, std::int64_t count, bool atEnd);

} // namespace grouser::output

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"

namespace grouser::output {

/// Reads the first `count` rows of `folder`/results.h5, which a run resumed at `step` keeps. Does not modify the file.
/// Throws base::InputError if the file cannot be read or contains fewer rows of these channels up to this step.
std::vector<Row> readRows(const std::filesystem::path& folder, const std::vector<Channel>& channels, std::int64_t step,
                          std::int64_t count);

/// Number of frames of `folder`/frames.h5 that a run resumed at `step` keeps: the `count` frames of its checkpoint and,
/// if `atEnd`, the final frame at `step` if the file contains it. Does not modify the file. Throws base::InputError if
/// frames are missing.
std::int64_t keptFrames(const std::filesystem::path& folder, std::int64_t step, std::int64_t count, bool atEnd);

} // namespace grouser::output

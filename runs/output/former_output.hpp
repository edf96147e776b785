// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"

namespace grouser::output {

/// Reads from `folder`/results.h5 its first `count` rows: those that a run keeps which is resumed at `step`. Touches
/// nothing. Throws base::InputError where the file cannot be read, or does not hold so many rows up to that step of
/// these channels.
std::vector<Row> readRows(const std::filesystem::path& folder, const std::vector<Channel>& channels, std::int64_t step,
                          std::int64_t count);

/// The same for the frames of `folder`/frames.h5, which stay in the file: throws unless they are there.
void checkFrames(const std::filesystem::path& folder, std::int64_t step, std::int64_t count);

/// Whether the file holds one more, of the very step: the end of a run that had none left to take.
bool holdsLastFrame(const std::filesystem::path& folder, std::int64_t step, std::int64_t count);

} // namespace grouser::output

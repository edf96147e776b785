// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"

namespace grouser::output {

/// Reads from `folder`/results.h5 its first `count` rows: those that a run keeps which is resumed at `step`. Touches
/// nothing. Throws base::InputError where the file cannot be read, or does not hold so many rows up to that step of
/// these channels.
std::vector<Row> readRows(const std::filesystem::path& folder, const std::vector<Channel>& channels, std::int64_t step,
                          std::int64_t count);

/// How many frames of `folder`/frames.h5 a run keeps that is resumed at `step`, where its checkpoint counted `count`:
/// these, and one more where `atEnd` and the file holds it: that of the very step, the end of a run that had none left
/// to take. They stay in the file. Throws base::InputError where it does not hold them.
std::int64_t keptFrames(const std::filesystem::path& folder, std::int64_t step, std::int64_t count, bool atEnd);

} // namespace grouser::output

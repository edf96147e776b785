// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/former_output.hpp"

#include "base/error.hpp"
#include "runs/output/frames_file.hpp"
#include "runs/support/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::output {

namespace fs = std::filesystem;

namespace {

/// Reads the rows that the checkpoint counted. Returns an error message, or an empty text.
std::string readCounted(const fs::path& path, const std::vector<Channel>& channels, std::int64_t step,
                        std::int64_t count, std::vector<Row>& rows) {
  const support::Hdf5File file = support::Hdf5File::open(path);
  const std::vector<std::int64_t> steps = file.read<std::int64_t>("/series/step");
  const std::vector<double> times = file.read<double>("/series/time");
  const std::size_t most = std::min({steps.size(), times.size(), static_cast<std::size_t>(count)});
  for (std::size_t i = 0; i < most && steps[i] <= step; ++i) rows.push_back({steps[i], times[i], {}});
  if (static_cast<std::int64_t>(rows.size()) != count)
    return fmt::format("contains {} rows up to step {}, but the checkpoint requires {}", rows.size(), step, count);
  for (const Channel& c : channels) {
    const std::vector<double> values = file.read<double>("/" + c.path + "/value");
    const auto width = static_cast<std::size_t>(c.width);
    if (values.size() < rows.size() * width) return fmt::format("contains too few rows of {}", c.path);
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].values.insert(rows[i].values.end(), values.begin() + static_cast<std::ptrdiff_t>(i * width),
                            values.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
  }
  return "";
}

} // namespace

std::vector<Row> readRows(const fs::path& folder, const std::vector<Channel>& channels, std::int64_t step,
                          std::int64_t count) {
  const fs::path path = folder / "results.h5";
  std::vector<Row> rows;
  std::string fault;
  try {
    fault = readCounted(path, channels, step, count, rows);
  } catch (const base::InputError& error) {
    fault = fmt::format("cannot be read ({})", error.what());
  }
  if (!fault.empty())
    throw base::InputError(fmt::format("{}: {}, so the rows before the checkpoint are lost; restore the original "
                                       "file, or continue without these rows with --force",
                                       path.string(), fault));
  return rows;
}

std::int64_t keptFrames(const fs::path& folder, std::int64_t step, std::int64_t count, bool atEnd) {
  if (count == 0 && !atEnd) return 0;
  std::int64_t found = -1;
  try {
    found = FramesFile::framesUpTo(folder, step);
  } catch (const base::InputError&) {
    if (count == 0) return 0; // a new file is created
  }
  if (found < count)
    throw base::InputError(fmt::format("{}: does not contain the {} frames up to step {} that the checkpoint requires; "
                                       "restore the original file, or continue without these frames with --force",
                                       (folder / "frames.h5").string(), count, step));
  return atEnd && found == count + 1 ? found : count;
}

} // namespace grouser::output

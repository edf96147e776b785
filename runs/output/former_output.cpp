// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/former_output.hpp"

#include "base/error.hpp"
#include "runs/output/frames_file.hpp"
#include "runs/support/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::output {

namespace fs = std::filesystem;

namespace {

/// Reads the rows that the checkpoint counted. Returns an error message, or an empty text.
std::string readCounted(const fs::path& path, const std::vector<Channel>& channels, std::int64_t step,
                        std::int64_t count, std::vector<Row>& rows) {
  const support::Hdf5File file = support::Hdf5File::open(path);
  // Rows after the checkpoint may be damaged by the end of the run, and are not read.
  const auto rowsOf = [&](const std::string& dataset) {
    const std::vector<std::uint64_t> shape = file.shape(dataset);
    return shape.empty() ? 0 : shape.front();
  };
  const std::uint64_t most =
      std::min({rowsOf("/series/step"), rowsOf("/series/time"), static_cast<std::uint64_t>(count)});
  const std::vector<std::int64_t> steps = file.readRows<std::int64_t>("/series/step", 0, most);
  const std::vector<double> times = file.readRows<double>("/series/time", 0, most);
  for (std::size_t i = 0; i < most && steps[i] <= step; ++i) {
    if (!std::isfinite(times[i]) || (i > 0 && steps[i] <= steps[i - 1]))
      return fmt::format("is damaged: row {} of /series has an invalid step or time", i);
    rows.push_back({steps[i], times[i], {}});
  }
  if (static_cast<std::int64_t>(rows.size()) != count)
    return fmt::format("contains {} rows up to step {}, but the checkpoint requires {}", rows.size(), step, count);
  for (const Channel& c : channels) {
    const auto width = static_cast<std::size_t>(c.width);
    const std::string dataset = "/" + c.path + "/value";
    if (rowsOf(dataset) < rows.size()) return fmt::format("contains too few rows of {}", c.path);
    const std::vector<double> values = file.readRows<double>(dataset, 0, rows.size());
    if (values.size() != rows.size() * width) return fmt::format("has rows of another width in {}", c.path);
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
  std::string fault;
  try {
    found = FramesFile::framesUpTo(folder, step, count + (atEnd ? 1 : 0));
  } catch (const base::InputError& error) {
    if (count == 0 && !atEnd) return 0; // a new file is created
    fault = fmt::format(" ({})", error.what());
  }
  if (found < count)
    throw base::InputError(
        fmt::format("{}: does not contain the {} frames up to step {} that the checkpoint requires{}; "
                    "restore the original file, or continue without these frames with --force",
                    (folder / "frames.h5").string(), count, step, fault));
  return atEnd && found == count + 1 ? found : count;
}

} // namespace grouser::output

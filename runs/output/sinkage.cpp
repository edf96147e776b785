// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/sinkage.hpp"

#include "base/error.hpp"
#include "runs/output/channels.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <vector>

namespace grouser::output {

std::filesystem::path writeSinkageCsv(const std::filesystem::path& results, const std::filesystem::path& folder) {
  const support::Hdf5File file = support::Hdf5File::open(results);
  if (file.text("/", "creator") != "grouser")
    throw base::InputError(
        fmt::format("{}: was not written by grouser; give the results.h5 of a run", results.string()));
  struct Track {
    std::string side;
    std::size_t shoes;
    std::vector<double> values; ///< [rows, shoes]
  };
  std::vector<Track> tracks;
  std::vector<double> time;
  for (const std::string side : {"left", "right"}) {
    const std::string group = fmt::format("/{}", shoeSinkage(side));
    if (!file.has(group + "/value")) continue;
    time = file.numbers(group + "/time");
    tracks.push_back({side, file.shape(group + "/value").back(), file.numbers(group + "/value")});
    if (tracks.back().values.size() != time.size() * tracks.back().shoes)
      throw base::InputError(
          fmt::format("{}: {} has another length than its times; the file is damaged, run the scene again",
                      results.string(), group));
  }
  if (tracks.empty())
    throw base::InputError(fmt::format(
        "{}: has no sinkage, for its scene has no vehicle; give the results of one that has", results.string()));

  std::string text = "time [s]";
  for (const Track& t : tracks)
    for (std::size_t s = 0; s < t.shoes; ++s) text += fmt::format(",{} {} [m]", t.side, s);
  for (std::size_t row = 0; row < time.size(); ++row) {
    text += fmt::format("\n{}", time[row]);
    for (const Track& t : tracks)
      for (std::size_t s = 0; s < t.shoes; ++s) text += fmt::format(",{}", t.values[row * t.shoes + s]);
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::filesystem::path path = folder / "sinkage.csv";
  support::writeTextFile(path, text + '\n', "--out");
  return path;
}

} // namespace grouser::output

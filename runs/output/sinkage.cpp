// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/sinkage.hpp"

#include "base/error.hpp"
#include "base/rounded.hpp"
#include "runs/output/channels.hpp"
#include "runs/support/hdf5_file.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace grouser::output {

namespace {

constexpr int kMaxShoes = 10000; // maximum length of a range, so that a typing error does not fill the memory

struct Track {
  std::string side;
  std::size_t shoes;
  std::vector<double> values; ///< [rows, shoes]
};

struct Tracks {
  std::vector<Track> tracks;
  std::vector<double> time;
};

/// `side`: "left" or "right"; empty: both tracks.
Tracks readSinkage(const std::filesystem::path& results, const std::string& chosen) {
  const support::Hdf5File file = support::Hdf5File::open(results);
  if (file.text("/", "creator") != "grouser")
    throw base::InputError(
        fmt::format("{}: was not written by grouser; specify the results.h5 of a run", results.string()));
  Tracks read;
  bool any = false;
  for (const std::string side : {"left", "right"}) {
    const std::string group = fmt::format("/{}", shoeSinkage(side));
    if (!file.has(group + "/value")) continue;
    any = true;
    if (!chosen.empty() && side != chosen) continue;
    read.time = file.numbers(group + "/time");
    const std::vector<std::uint64_t> shape = file.shape(group + "/value");
    if (shape.size() == 2) read.tracks.push_back({side, shape.back(), file.numbers(group + "/value")});
    if (std::adjacent_find(read.time.begin(), read.time.end(), [](double a, double b) { return !(a < b); }) !=
        read.time.end())
      throw base::InputError(fmt::format("{}: {}/time is not ascending; the file is damaged; run the scene again",
                                         results.string(), group));
    if (shape.size() != 2 || read.tracks.back().values.size() != read.time.size() * read.tracks.back().shoes)
      throw base::InputError(
          fmt::format("{}: {} and its time series differ in length; the file is damaged; run the scene again",
                      results.string(), group));
  }
  if (any && read.tracks.empty())
    throw base::InputError(fmt::format("--track {}: {} has no such track", chosen, results.string()));
  if (read.tracks.empty())
    throw base::InputError(fmt::format(
        "{}: contains no sinkage, because its scene has no vehicle; specify the results of a run with a vehicle",
        results.string()));
  return read;
}

/// Removes a whole number from the front of `text` and returns it; empty if there is none.
std::optional<int> takeNumber(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || number < 0) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

} // namespace

std::vector<int> shoesNamed(const std::string& list) {
  const auto refuse = [&](const std::string& why) {
    throw base::InputError(
        fmt::format("--shoes {}: {}; list shoe numbers or ranges, counted from 0, e.g. 10-13,20", list, why));
  };
  std::vector<int> shoes;
  std::string_view rest = list;
  while (true) {
    const std::optional<int> first = takeNumber(rest);
    if (!first) refuse("is not a list of shoes");
    int last = *first;
    if (!rest.empty() && rest.front() == '-') {
      rest.remove_prefix(1);
      const std::optional<int> end = takeNumber(rest);
      if (!end) refuse("has a range without an end");
      last = *end;
      if (last < *first) refuse("has a descending range");
      if (last - *first > kMaxShoes) refuse("exceeds the number of shoes of any track");
    }
    for (int s = *first; s <= last; ++s) shoes.push_back(s);
    if (rest.empty()) break;
    if (rest.front() != ',') refuse("is not a list of shoes");
    rest.remove_prefix(1);
  }
  return shoes;
}

void requireShoes(const std::filesystem::path& results, const std::vector<int>& shoes, const std::string& track) {
  for (const Track& t : readSinkage(results, track).tracks)
    for (const int s : shoes)
      if (static_cast<std::size_t>(s) >= t.shoes)
        throw base::InputError(fmt::format("--shoes: shoe {} does not exist; the {} track of {} has shoes 0 to {}", s,
                                           t.side, results.string(), t.shoes - 1));
}

std::filesystem::path writeSinkageCsv(const std::filesystem::path& results, const std::filesystem::path& folder,
                                      const std::vector<int>& shoes, const std::string& track) {
  const Tracks read = readSinkage(results, track);
  const auto chosen = [&](const Track& t) {
    std::vector<std::size_t> list(shoes.begin(), shoes.end());
    if (shoes.empty())
      for (std::size_t s = 0; s < t.shoes; ++s) list.push_back(s);
    return list;
  };
  if (!shoes.empty()) requireShoes(results, shoes, track);
  std::string text = "time [s]";
  for (const Track& t : read.tracks)
    for (const std::size_t s : chosen(t)) text += fmt::format(",{} {} [m]", t.side, s);
  for (std::size_t row = 0; row < read.time.size(); ++row) {
    text += fmt::format("\n{}", base::nearestDecimal(read.time[row]));
    for (const Track& t : read.tracks)
      for (const std::size_t s : chosen(t)) text += fmt::format(",{}", t.values[row * t.shoes + s]);
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::filesystem::path path = folder / (shoes.empty() ? "sinkage.csv" : "sinkage_shoes.csv");
  support::writeTextFile(path, text + '\n', "--out");
  return path;
}

} // namespace grouser::output

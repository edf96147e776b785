// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/sweeps/run_series.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "runs/campaigns/sweeps/run_manifest.hpp"
#include "runs/support/file_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>

namespace grouser::sweeps {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> cellsOf(std::string_view line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.emplace_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return cells;
}

double numberIn(const std::string& cell) {
  char* end = nullptr;
  const double number = std::strtod(cell.c_str(), &end);
  return end == cell.c_str() ? std::numeric_limits<double>::quiet_NaN() : number;
}

/// A CSV file of numbers with a header line.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<double>> rows;
};

/// `checksum`: of the file; empty if unknown.
Table readTable(const fs::path& path, const std::string& checksum = "") {
  std::stringstream file(base::readInput(path, "run the scene again"));
  if (!checksum.empty() && fmt::format("{:08x}", support::crc32(file.view())) != checksum)
    throw base::InputError(
        fmt::format("{}: the file is damaged: wrong checksum; run the scene again, or restore the file from a copy",
                    path.string()));
  std::string line;
  if (!std::getline(file, line)) throw base::InputError(fmt::format("{}: cannot be read", path.string()));
  Table table{cellsOf(line), {}};
  while (std::getline(file, line)) {
    std::vector<double> row;
    for (const std::string& cell : cellsOf(line)) row.push_back(numberIn(cell));
    if (row.size() != table.head.size())
      throw base::InputError(fmt::format("{}:{}: row has {} cells, but the table has {} columns; run the scene again",
                                         path.string(), table.rows.size() + 2, row.size(), table.head.size()));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Whether the first output time has few grains; reads only that part of the file.
bool hasFewGrains(const fs::path& path) {
  std::ifstream file(path);
  std::string line, first;
  std::getline(file, line);
  std::size_t grains = 0;
  while (grains <= kGrainsWithSeries && std::getline(file, line)) {
    const std::string step = line.substr(0, line.find(','));
    if (grains > 0 && step != first) break;
    first = step, ++grains;
  }
  return grains <= kGrainsWithSeries;
}

/// Adds the grains of grains.csv (step, time, id, quantities) in the order of the rows.
void addGrains(const Table& table, RunSeries& series) {
  constexpr std::size_t kId = 2, kFirst = 3;
  std::map<long long, std::vector<std::size_t>> rowsOf;
  for (std::size_t r = 0; r < table.rows.size(); ++r) rowsOf[static_cast<long long>(table.rows[r][kId])].push_back(r);
  if (rowsOf.size() > kGrainsWithSeries) return;
  for (const auto& [id, rows] : rowsOf) {
    if (rows.size() != series.time.size()) continue; // inserted later, or removed
    for (std::size_t c = kFirst; c < table.head.size(); ++c) {
      if (table.head[c].starts_with("radius")) continue;
      series.columns.push_back(fmt::format("grain.{}.{}", id, table.head[c]));
      std::vector<double>& values = series.values.emplace_back();
      for (const std::size_t r : rows) values.push_back(table.rows[r][c]);
    }
  }
}

} // namespace

const std::vector<double>* RunSeries::of(const std::string& column) const {
  const auto at = std::find(columns.begin(), columns.end(), column);
  return at == columns.end() ? nullptr : &values[static_cast<std::size_t>(at - columns.begin())];
}

void RunSeries::keepEnd() {
  const auto shorten = [](std::vector<double>& all) {
    if (all.size() > 1) all = {all.back()};
  };
  shorten(time);
  for (std::vector<double>& column : values) shorten(column);
}

RunSeries readSeries(const fs::path& folder) {
  constexpr std::size_t kTime = 1, kFirst = 2; // step comes first
  const Table table = readTable(folder / "timeseries.csv", RunManifest(folder).checksumOf("timeseries.csv"));
  RunSeries series;
  for (const std::vector<double>& row : table.rows) series.time.push_back(row[kTime]);
  for (std::size_t c = kFirst; c < table.head.size(); ++c) {
    series.columns.push_back(table.head[c]);
    std::vector<double>& values = series.values.emplace_back();
    for (const std::vector<double>& row : table.rows) values.push_back(row[c]);
  }
  const fs::path grains = folder / "grains.csv";
  std::error_code error;
  if (fs::exists(grains, error) && hasFewGrains(grains)) addGrains(readTable(grains), series);
  return series;
}

} // namespace grouser::sweeps

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/runs/folder_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace grouser::test {

/// A table of text cells, without quotes.
struct Csv {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  explicit Csv(const std::filesystem::path& path) {
    std::istringstream stream(contents(path));
    for (std::string line; std::getline(stream, line);) {
      std::vector<std::string> cells(1);
      bool inQuotes = false;
      for (const char c : line) {
        if (c == '"')
          inQuotes = !inQuotes;
        else if (c == ',' && !inQuotes)
          cells.emplace_back();
        else
          cells.back() += c;
      }
      header.empty() ? header = cells : (rows.push_back(cells), header);
    }
  }
  std::string at(std::size_t row, const std::string& column) const {
    const auto found = std::find(header.begin(), header.end(), column);
    if (found == header.end() || row >= rows.size()) return "no such cell";
    return rows[row][static_cast<std::size_t>(found - header.begin())];
  }
  /// A cell as a number, NaN if it is empty or missing.
  double number(std::size_t row, const std::string& column) const {
    const std::string cell = at(row, column);
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    return end == cell.c_str() ? std::nan("") : value;
  }
};

} // namespace grouser::test

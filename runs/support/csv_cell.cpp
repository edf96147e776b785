// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/csv_cell.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grouser::support {

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return cell + "\"";
}

std::string csvCell(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

} // namespace grouser::support

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/measured_plates.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>

namespace grouser::virtual_tests {

namespace {

constexpr std::array<const char*, 4> kColumns = {"trial", "plate_diameter_mm", "sinkage_mm", "pressure_kPa"};
constexpr double kMinDeviation = 0.01; ///< [-] minimum relative deviation, for tests that agree by chance

struct Test {
  double diameter = 0;                   ///< [m]
  std::vector<double> sinkage, pressure; ///< [m], [Pa]
};

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else if (c != '\r' && c != ' ')
      cells.back() += c;
  }
  return cells;
}

class Reader {
public:
  explicit Reader(const std::filesystem::path& file)
      : file_(file), in_(base::readInput(file, "correct plates.file, which is relative to the target file")) {}

  std::map<int, Test> tests() {
    readHead();
    std::map<int, Test> tests;
    for (std::string line; next(line);) addRow(cellsOf(line), tests);
    if (tests.empty()) fail("the file has no rows after the column names; add the measured tests");
    return tests;
  }

private:
  [[noreturn]] void fail(const std::string& message) const {
    throw base::InputError(fmt::format("{}:{}: {}", file_.string(), line_, message));
  }

  /// The next line that is neither empty nor a comment.
  bool next(std::string& line) {
    while (std::getline(in_, line)) {
      ++line_;
      if (!line.empty() && line[0] != '#' && line != "\r") return true;
    }
    return false;
  }

  void readHead() {
    std::string line;
    if (!next(line)) fail("the file is empty; add a first row with the column names, and the measured tests");
    const std::vector<std::string> names = cellsOf(line);
    for (std::size_t k = 0; k < kColumns.size(); ++k) {
      const auto found = std::find(names.begin(), names.end(), kColumns[k]);
      if (found == names.end())
        fail(fmt::format("column {} is missing; the required columns are {}, {}, {} and {}", kColumns[k], kColumns[0],
                         kColumns[1], kColumns[2], kColumns[3]));
      column_[k] = static_cast<std::size_t>(found - names.begin());
    }
  }

  double number(const std::vector<std::string>& cells, std::size_t k) const {
    const std::string text = column_[k] < cells.size() ? cells[column_[k]] : "";
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(fmt::format("{} = \"{}\" is not a number", kColumns[k], text));
    return value;
  }

  void addRow(const std::vector<std::string>& cells, std::map<int, Test>& tests) const {
    const double trial = number(cells, 0), diameter = 1e-3 * number(cells, 1);
    if (trial != std::floor(trial) || trial < 0 || trial > 1e9) fail("trial must be a whole number >= 0");
    if (!(diameter > 0 && diameter <= 10)) fail("plate_diameter_mm is outside (0, 10000]");
    Test& test = tests[static_cast<int>(trial)];
    if (!test.sinkage.empty() && test.diameter != diameter)
      fail(fmt::format("trial {} has plates of {:g} and {:g} mm; use a different trial number for each test", trial,
                       1e3 * test.diameter, 1e3 * diameter));
    test.diameter = diameter;
    test.sinkage.push_back(1e-3 * number(cells, 2)), test.pressure.push_back(1e3 * number(cells, 3));
  }

  std::filesystem::path file_;
  std::istringstream in_;
  int line_ = 0;
  std::array<std::size_t, 4> column_{};
};

/// y at the first point where x reaches `value`, by linear interpolation; empty if x never reaches it or starts above.
std::optional<double> valueAt(const std::vector<double>& x, const std::vector<double>& y, double value) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < value) continue;
    if (i == 0) return x[0] == value ? std::optional(y[0]) : std::nullopt;
    return y[i - 1] + (value - x[i - 1]) / (x[i] - x[i - 1]) * (y[i] - y[i - 1]);
  }
  return {};
}

/// Mean sinkage at which the tests of a plate first reach a pressure.
double contactOf(const std::filesystem::path& file, const std::map<int, Test>& tests, double diameter,
                 double pressure) {
  double sum = 0, count = 0;
  for (const auto& [number, test] : tests) {
    if (test.diameter != diameter) continue;
    const std::optional<double> sinkage = valueAt(test.pressure, test.sinkage, pressure);
    if (!sinkage)
      throw base::InputError(fmt::format(
          "{}: trial {} {} plates.contact_pressure = {:g} Pa; choose a pressure between {:g} and "
          "{:g} Pa",
          file.string(), number, test.pressure.front() > pressure ? "begins above" : "never reaches", pressure,
          std::max(0.0, test.pressure.front()), *std::max_element(test.pressure.begin(), test.pressure.end())));
    sum += *sinkage, ++count;
  }
  return sum / count;
}

MeasuredPressure pointOf(const std::map<int, Test>& tests, double diameter, double sinkage) {
  MeasuredPressure point;
  point.sinkage = sinkage;
  for (const auto& [number, test] : tests)
    if (test.diameter == diameter)
      if (const std::optional<double> pressure = valueAt(test.sinkage, test.pressure, sinkage))
        point.trials.push_back({number, *pressure});
  const auto n = static_cast<double>(point.trials.size());
  for (const MeasuredTrial& t : point.trials) point.mean += t.pressure / n;
  double squares = 0;
  for (const MeasuredTrial& t : point.trials) squares += (t.pressure - point.mean) * (t.pressure - point.mean);
  if (n > 1) point.deviation = std::max(kMinDeviation, std::sqrt(squares / (n - 1)) / point.mean);
  return point;
}

/// Sets the deviation of tests that were not repeated.
void poolDeviations(std::vector<MeasuredPlate>& plates) {
  double squares = 0, count = 0;
  for (const MeasuredPlate& plate : plates)
    for (const MeasuredPressure& point : plate.points)
      if (point.trials.size() > 1) squares += point.deviation * point.deviation, ++count;
  constexpr double kAssumed = 0.1; // [-] deviation if no test was repeated
  const double pooled = count > 0 ? std::sqrt(squares / count) : kAssumed;
  for (MeasuredPlate& plate : plates)
    for (MeasuredPressure& point : plate.points)
      if (point.trials.size() == 1) point.deviation = pooled;
}

} // namespace

std::vector<MeasuredPlate> readMeasuredPlates(const std::filesystem::path& file, const std::vector<double>& sinkages,
                                              double contactPressure) {
  const std::map<int, Test> tests = Reader(file).tests();
  std::map<double, MeasuredPlate> byDiameter;
  for (const auto& [number, test] : tests) byDiameter[test.diameter].diameter = test.diameter;
  std::vector<MeasuredPlate> plates;
  for (auto& [diameter, plate] : byDiameter) {
    for (const double sinkage : sinkages) {
      MeasuredPressure point = pointOf(tests, diameter, sinkage);
      if (point.trials.empty()) continue;
      if (!(point.mean > 0))
        throw base::InputError(fmt::format(
            "{}: the mean pressure of the plate of {:g} mm is {:g} kPa at a sinkage of {:g} mm, but must be positive; "
            "remove this sinkage from plates.sinkages",
            file.string(), 1e3 * diameter, 1e-3 * point.mean, 1e3 * sinkage));
      plate.points.push_back(std::move(point));
    }
    if (plate.points.empty()) continue;
    if (contactPressure > 0) plate.contact = contactOf(file, tests, diameter, contactPressure);
    plates.push_back(std::move(plate));
  }
  for (const double sinkage : sinkages) {
    const auto reaches = [&](const MeasuredPlate& plate) {
      return std::any_of(plate.points.begin(), plate.points.end(), [&](const auto& p) { return p.sinkage == sinkage; });
    };
    if (std::none_of(plates.begin(), plates.end(), reaches))
      throw base::InputError(fmt::format("{}: no test reaches a sinkage of {:g} mm; remove it from plates.sinkages",
                                         file.string(), 1e3 * sinkage));
  }
  poolDeviations(plates);
  return plates;
}

} // namespace grouser::virtual_tests

// SPDX-License-Identifier: BSD-3-Clause
// Grains from a text file: one grain per line, separated by blanks, tabs, commas or semicolons.
#include "base/error.hpp"
#include "base/input_file.hpp"
#include "runs/scene/scene.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <string_view>

namespace grouser::scene {

namespace {

/// Name, unit and range of a column, as in [[grain]].
struct Column {
  const char *name, *unit;
  double least, most;
};
constexpr double kFar = std::numeric_limits<double>::max(); // positions have separate limits, from the grain radii
constexpr std::array<Column, 10> kColumns{{{"x", "m", -kFar, kFar},
                                           {"y", "m", -kFar, kFar},
                                           {"z", "m", -kFar, kFar},
                                           {"r", "m", 0, 1e3},
                                           {"vx", "m/s", -1e4, 1e4},
                                           {"vy", "m/s", -1e4, 1e4},
                                           {"vz", "m/s", -1e4, 1e4},
                                           {"wx", "rad/s", -1e6, 1e6},
                                           {"wy", "rad/s", -1e6, 1e6},
                                           {"wz", "rad/s", -1e6, 1e6}}};
constexpr std::size_t kRadius = 3;
constexpr const char* kLines = "x, y, z, r [m], optionally with vx, vy, vz [m/s], then wx, wy, wz [rad/s]";

bool isComplete(std::size_t columns) { return columns == 4 || columns == 7 || columns == 10; }

struct TextField {
  std::string_view text;
  std::size_t at; ///< index of its first character
};

/// One line of the file; errors name its position.
struct TextLine {
  const std::string& file;
  int number;
  std::string_view text; ///< without its comment

  [[noreturn]] void fail(std::size_t at, const std::string& message) const {
    throw base::InputError(fmt::format("{}:{}:{}: {}", file, number, at + 1, message));
  }
};

constexpr std::string_view kBlank = " \t\v\f";

TextField trimmed(std::string_view line, std::size_t from, std::size_t to) {
  while (from < to && kBlank.find(line[from]) != std::string_view::npos) ++from;
  while (to > from && kBlank.find(line[to - 1]) != std::string_view::npos) --to;
  return {line.substr(from, to - from), from};
}

/// Splits a line at commas or semicolons if it contains any, otherwise at blanks and tabs. Two tabs in a row enclose an
/// empty field, which is an error as between two commas.
std::vector<TextField> fieldsOf(const TextLine& line) {
  const std::string_view text = line.text;
  std::vector<TextField> fields;
  const std::size_t comma = text.find(','), semicolon = text.find(';');
  const auto empty = [&](std::size_t at) {
    line.fail(
        at, fmt::format("column {} is empty; add a number, e.g. 0, or remove the extra separator", fields.size() + 1));
  };
  if (comma != std::string_view::npos && semicolon != std::string_view::npos)
    line.fail(std::max(comma, semicolon),
              "line contains both commas and semicolons; use one separator, and write decimals with a point, e.g. 1.5");
  const std::size_t first = std::min(comma, semicolon);
  if (first != std::string_view::npos) {
    const char separator = text[first];
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t to = std::min(text.find(separator, from), text.size());
      fields.push_back(trimmed(text, from, to));
      if (fields.back().text.empty()) fields.pop_back(), empty(from);
      from = to + 1;
    }
    return fields;
  }
  for (std::size_t from = 0; from < text.size();) {
    std::size_t at = from, tabs = 0;
    for (; at < text.size() && kBlank.find(text[at]) != std::string_view::npos; ++at)
      if (text[at] == '\t' && ++tabs == 2) empty(at);
    if (at == text.size()) break;
    from = std::min(text.find_first_of(kBlank, at), text.size());
    fields.push_back({text.substr(at, from - at), at});
  }
  return fields;
}

/// Returns true if the first line names columns (with or without quotes).
bool isHeader(const std::vector<TextField>& fields) {
  std::string_view word = fields[0].text;
  if (word.size() > 1 && word[0] == '"') word.remove_prefix(1);
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  double ignored = 0; // "nan" and "inf" are numbers, not column names
  return isLetter(word[0]) && std::from_chars(word.data(), word.data() + word.size(), ignored).ec != std::errc();
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return lower;
}

/// Returns the number of columns in the header. With blanks as separators, a unit may be a separate field: "x [m]".
std::size_t readHeader(const TextLine& line, const std::vector<TextField>& fields) {
  std::size_t column = 0;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    std::string text(fields[k].text);
    while (k + 1 < fields.size() && (fields[k + 1].text[0] == '[' || fields[k + 1].text[0] == '('))
      text += fields[++k].text;
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '"' || c == ' '; }), text.end());
    if (column == kColumns.size())
      line.fail(fields[k].at,
                fmt::format("column 11 of the header is \"{:.40}\", but lines have at most {} numbers: {}", text,
                            kColumns.size(), kLines));
    const Column& wanted = kColumns[column++];
    const std::size_t open = text.find_first_of("[(");
    const std::string name = lowerCase(text.substr(0, open));
    if (name != wanted.name && !(column == kRadius + 1 && name == "radius"))
      line.fail(fields[k].at,
                fmt::format("column {} of the header is \"{:.40}\", expected \"{} [{}]\"; the columns are {}", column,
                            text, wanted.name, wanted.unit, kLines));
    if (open == std::string::npos) continue;
    const std::string unit = text.substr(open + 1, text.find_first_of("])", open) - open - 1);
    if (unit != wanted.unit)
      line.fail(
          fields[k].at,
          fmt::format("column {} of the header has unit [{:.40}], expected [{}]; convert the numbers to {} in [{}]",
                      column, unit, wanted.unit, wanted.name, wanted.unit));
  }
  if (!isComplete(column)) line.fail(0, fmt::format("the header has {} columns; expected {}", column, kLines));
  return column;
}

double readNumber(const TextLine& line, const TextField& field, std::size_t column) {
  const std::string_view text = field.text;
  const bool plus = text[0] == '+' && text.size() > 1 && text[1] != '-';
  const char *from = text.data() + plus, *to = text.data() + text.size();
  double value = 0;
  const auto [end, error] = std::from_chars(from, to, value);
  const Column& c = kColumns[column];
  const auto fail = [&](const std::string& message) {
    line.fail(field.at, fmt::format("column {}, {} = {:.40} [{}] {}", column + 1, c.name, text, c.unit, message));
  };
  if (text[0] == '"') fail("is in quotes; remove them");
  if (error == std::errc::result_out_of_range) fail("is outside the range of double precision; correct it");
  if (error != std::errc() || end != to)
    fail("is not a number; write decimals with a point, e.g. 1.5e-3, and separate numbers by commas or blanks");
  if (!std::isfinite(value)) fail("is not finite; correct it");
  if (column == kRadius ? !(value > c.least && value <= c.most) : !(value >= c.least && value <= c.most))
    fail(fmt::format("is outside {}{:g}, {:g}]; correct it", column == kRadius ? '(' : '[', c.least, c.most));
  return value;
}

std::string textOf(const std::string& file) {
  std::string text = base::readInput(file, "specify a text file with one grain per line");
  if (text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3); // UTF-8's byte order mark, as in TOML files
  if (text.rfind("\xFF\xFE", 0) == 0 || text.rfind("\xFE\xFF", 0) == 0 || text.find('\0') != std::string::npos)
    throw base::InputError(
        fmt::format("{}: not plain text (UTF-16, compressed or binary); save it as UTF-8 or ASCII text", file));
  return text;
}

} // namespace

std::vector<Grain> readGrainFile(const std::string& file, const GrainFill& fill) {
  const std::string all = textOf(file);
  std::vector<Grain> grains;
  std::optional<std::size_t> header, width; // numbers of columns in the header and in the line of the first grain
  int number = 0;
  for (std::size_t from = 0; from < all.size();) {
    const std::size_t end = std::min(all.find_first_of("\r\n", from), all.size());
    std::string_view text = std::string_view(all).substr(from, end - from);
    from = end + (all.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    const TextLine line{file, ++number, text.substr(0, text.find('#'))};
    if (line.text.find_first_not_of(kBlank) == std::string_view::npos) continue;
    const std::vector<TextField> fields = fieldsOf(line);
    if (grains.empty() && !header && isHeader(fields)) {
      header = readHeader(line, fields);
      continue;
    }
    if (fields.size() != header.value_or(fields.size()))
      line.fail(0, fmt::format("line has {} numbers, but the header has {} columns; correct the line", fields.size(),
                               *header));
    std::array<double, kColumns.size()> values{};
    for (std::size_t k = 0; k < std::min(fields.size(), values.size()); ++k) values[k] = readNumber(line, fields[k], k);
    if (!isComplete(fields.size()))
      line.fail(0, fmt::format("line has {} numbers; expected {}", fields.size(), kLines));
    if (!width) width = fields.size();
    if (fields.size() != *width)
      line.fail(0, fmt::format("line has {} numbers, but earlier lines have {}; use the same number in all lines",
                               fields.size(), *width));
    const auto vectorAt = [&](std::size_t at) { return base::Vec3d{values[at], values[at + 1], values[at + 2]}; };
    grains.push_back({vectorAt(0),
                      fields.size() >= 7 ? vectorAt(4) : fill.velocity,
                      fields.size() >= 10 ? vectorAt(7) : fill.spin,
                      values[kRadius],
                      fill.material,
                      {}});
  }
  if (grains.empty()) throw base::InputError(fmt::format("{}: contains no grains; add lines with {}", file, kLines));
  return grains;
}

} // namespace grouser::scene

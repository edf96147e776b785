// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/searched_height_field.hpp"

#include "terrain/feet_search.hpp"

#include <algorithm>

namespace grouser::terrain {

namespace {

/// Marks all entries within `reach` of a marked entry in a row of `n`, `stride` apart.
void widen(const std::vector<bool>& from, std::vector<bool>& to, std::size_t first, int n, std::size_t stride,
           int reach) {
  int covered = 0; // end of the marked range
  for (int k = 0; k < n; ++k) {
    if (!from[first + static_cast<std::size_t>(k) * stride]) continue;
    const int end = reach < n - k ? k + reach + 1 : n;
    for (int m = std::max(covered, k - reach); m < end; ++m) to[first + static_cast<std::size_t>(m) * stride] = true;
    covered = end;
  }
}

} // namespace

SearchedHeightField::SearchedHeightField(const base::Exec& exec, const HeightField& field, double radius)
    : heights_(exec, field.heights()), tops_(exec), slopes_(exec, field.slopes()), marks_(exec), view_(field.view()) {
  view_.heights = heights_.data();
  view_.slopes = field.slopes().empty() ? nullptr : slopes_.data();
  if (hasHollows(field, radius)) mark(exec, field, radius);
}

void SearchedHeightField::mark(const base::Exec& exec, const HeightField& field, double radius) {
  const int columns = field.columns() - 1, rows = field.rows() - 1;
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<double> tops(count);
  std::vector<bool> hollow(count), inRows(count), near(count);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const HeightFieldBounds cell = field.boundsOfCell(i, j);
      const std::size_t k =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
      tops[k] = cell.highest, hollow[k] = cell.valleyCurvature * radius >= 1;
    }
  const auto cells = [radius](double d, int n) { return static_cast<int>(std::min<double>(n, radius / d)) + 1; };
  const auto width = static_cast<std::size_t>(columns);
  for (int j = 0; j < rows; ++j)
    widen(hollow, inRows, static_cast<std::size_t>(j) * width, columns, 1, cells(view_.dx, columns));
  for (int i = 0; i < columns; ++i)
    widen(inRows, near, static_cast<std::size_t>(i), rows, width, cells(view_.dy, rows));
  std::vector<std::uint8_t> marks(count);
  for (std::size_t k = 0; k < count; ++k)
    marks[k] = static_cast<std::uint8_t>((near[k] ? kNearHollow : 0) | (hollow[k] ? kInHollow : 0));
  tops_ = base::Array<double>(exec, tops), marks_ = base::Array<std::uint8_t>(exec, marks);
  view_.tops = tops_.data(), view_.marks = marks_.data();
}

} // namespace grouser::terrain

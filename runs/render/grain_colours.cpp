// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/grain_colours.hpp"

#include "base/error.hpp"
#include "base/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace grouser::render {

namespace {

const std::vector<std::pair<std::string, GrainQuantity>> kQuantities = {{"depth", GrainQuantity::Depth},
                                                                        {"speed", GrainQuantity::Speed},
                                                                        {"subdomain", GrainQuantity::Subdomain},
                                                                        {"role", GrainQuantity::Role},
                                                                        {"white", GrainQuantity::White}};
constexpr float kEmpty = -std::numeric_limits<float>::infinity();
constexpr std::size_t kValuesTaken = 200000; ///< maximum number of values per sampled frame, for the colour range

// Colours of two subdomains and of spanning grains as in the source paper.
Colour evenColour() { return srgb(240, 240, 238); }
Colour oddColour() { return srgb(72, 74, 78); }
Colour spanningColour() { return srgb(206, 34, 30); }

/// Colours distinguishable for the colour-blind (Wong, Nature Methods 8, 2011).
Colour subdomainColour(int subdomain) {
  static constexpr int kMap[8][3] = {{0, 114, 178},  {230, 159, 0}, {0, 158, 115},  {204, 121, 167},
                                     {86, 180, 233}, {213, 94, 0},  {240, 228, 66}, {120, 120, 120}};
  const int* c = kMap[subdomain % 8];
  return srgb(c[0], c[1], c[2]);
}

int numberOf(const Borders& borders, const std::array<int, 3>& place) {
  const int ny = static_cast<int>(borders[1].size()) + 1, nz = static_cast<int>(borders[2].size()) + 1;
  return (place[0] * ny + place[1]) * nz + place[2];
}

int subdomains(const Borders& borders) {
  return static_cast<int>((borders[0].size() + 1) * (borders[1].size() + 1) * (borders[2].size() + 1));
}

} // namespace

GrainQuantity grainQuantity(const std::string& word) {
  std::vector<std::string> names;
  for (const auto& [name, quantity] : kQuantities) {
    if (name == word) return quantity;
    names.push_back(name);
  }
  names.insert(names.end(), {"sinkage", "pressure", "shear"});
  throw base::InputError(fmt::format("--color {}: must be depth, speed, subdomain, role, white, sinkage, pressure or "
                                     "shear; did you mean {}?",
                                     word, base::nearestWord(word, names)));
}

Borders bordersOf(const std::vector<std::string>& words) {
  Borders borders;
  for (const std::string& word : words) {
    const auto fail = [&](const std::string& why) {
      throw base::InputError(
          fmt::format("--borders {}: {}; set an axis and positions in metres, e.g. x=0.5 or y=-1,1", word, why));
    };
    if (word.size() < 3 || word[1] != '=' || word[0] < 'x' || word[0] > 'z') fail("not of the form AXIS=POSITIONS");
    std::vector<double>& places = borders[static_cast<std::size_t>(word[0] - 'x')];
    for (std::size_t begin = 2; begin <= word.size();) {
      const std::size_t end = std::min(word.find(',', begin), word.size());
      double place = 0;
      const auto [stop, error] = std::from_chars(word.data() + begin, word.data() + end, place);
      if (error != std::errc{} || stop != word.data() + end || !std::isfinite(place))
        fail(fmt::format("\"{}\" is not a number", word.substr(begin, end - begin)));
      places.push_back(place);
      begin = end + 1;
    }
    std::sort(places.begin(), places.end());
    if (std::adjacent_find(places.begin(), places.end()) != places.end()) fail("duplicate position");
  }
  return borders;
}

std::array<int, 3> subdomainAt(const Borders& borders, const base::Vec3f& p_W) {
  std::array<int, 3> place{};
  for (int k = 0; k < 3; ++k) {
    const std::vector<double>& b = borders[static_cast<std::size_t>(k)];
    place[static_cast<std::size_t>(k)] =
        static_cast<int>(std::upper_bound(b.begin(), b.end(), double{p_W[k]}) - b.begin());
  }
  return place;
}

bool spans(const Borders& borders, const base::Vec3f& p_W, float radius) {
  for (int k = 0; k < 3; ++k)
    for (const double place : borders[static_cast<std::size_t>(k)])
      if (std::fabs(double{p_W[k]} - place) < double{radius}) return true;
  return false;
}

BedTop::BedTop(const output::StoredFrame& frame) {
  if (frame.positions.empty()) return;
  float xMin = frame.positions[0].x, xMax = xMin, yMin = frame.positions[0].y, yMax = yMin;
  for (const base::Vec3f& p : frame.positions) {
    xMin = std::min(xMin, p.x), xMax = std::max(xMax, p.x);
    yMin = std::min(yMin, p.y), yMax = std::max(yMax, p.y);
  }
  const float radius = *std::max_element(frame.radii.begin(), frame.radii.end());
  // A single distant grain must not make the grid huge.
  const double most = 4.0 * static_cast<double>(frame.positions.size()) + 64, dx = xMax - xMin, dy = yMax - yMin;
  edge_ = std::max(4.0 * double{radius}, 1e-9);
  while ((dx / edge_ + 1) * (dy / edge_ + 1) > most) edge_ *= 2;
  xMin_ = xMin, yMin_ = yMin;
  columns_ = static_cast<int>(dx / edge_) + 1, rows_ = static_cast<int>(dy / edge_) + 1;
  top_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kEmpty);
  const auto at = [&](int column, int row) -> float& {
    return top_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
  };
  for (std::size_t i = 0; i < frame.positions.size(); ++i) {
    const base::Vec3f& p = frame.positions[i];
    float& top = at(static_cast<int>((p.x - xMin_) / edge_), static_cast<int>((p.y - yMin_) / edge_));
    top = std::max(top, p.z + frame.radii[i]);
  }
  // Fills empty cells from the nearest filled cells.
  std::vector<std::pair<int, int>> front;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      if (at(column, row) != kEmpty) front.emplace_back(column, row);
  for (std::size_t next = 0; next < front.size(); ++next) {
    const auto [column, row] = front[next];
    for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y)
      for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x)
        if (at(x, y) == kEmpty) at(x, y) = at(column, row), front.emplace_back(x, y);
  }
}

double BedTop::height(double x, double y) const {
  if (top_.empty()) return 0;
  const auto cell = [](double place, int count) {
    return static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, double(count - 1)));
  };
  return double{top_[cell((y - yMin_) / edge_, rows_) * static_cast<std::size_t>(columns_) +
                     cell((x - xMin_) / edge_, columns_)]};
}

GrainColours::GrainColours(GrainQuantity quantity, const output::StoredFrame& first,
                           const std::vector<output::StoredFrame>& samples, std::optional<ValueRange> range)
    : quantity_(quantity), fluid_(first.fluid) {
  if (quantity == GrainQuantity::Depth) top_ = BedTop(first);
  if (range) range_ = *range;
  if (range || !hasRange()) return;
  std::vector<double> values;
  for (const output::StoredFrame& frame : samples) {
    const std::size_t step = frame.positions.size() / kValuesTaken + 1;
    for (std::size_t i = 0; i < frame.positions.size(); i += step) values.push_back(value(frame, i));
  }
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 100;
  range_ = {values[cut], values[values.size() - 1 - cut]};
  if (quantity == GrainQuantity::Speed) range_.low = 0;
  const double least = quantity == GrainQuantity::Depth ? 1e-6 : 1e-3; // minimum range [m, m/s]
  if (range_.high - range_.low < least) range_.high = range_.low + least;
}

double GrainColours::value(const output::StoredFrame& frame, std::size_t grain) const {
  if (quantity_ == GrainQuantity::Speed) return double{frame.speeds[grain]};
  const base::Vec3f& p = frame.positions[grain];
  return top_.height(double{p.x}, double{p.y}) - double{p.z};
}

std::string GrainColours::title() const {
  switch (quantity_) {
  case GrainQuantity::Depth:
    return "depth [m]";
  case GrainQuantity::Speed:
    return "speed [m/s]";
  case GrainQuantity::Subdomain:
    return "subdomain";
  case GrainQuantity::Role:
    return "role";
  case GrainQuantity::White:
    break;
  }
  return "";
}

Colour GrainColours::scaleColour(double place) const {
  // Deep grains are dark, fast grains light.
  const double p = quantity_ == GrainQuantity::Depth ? 1 - place : place;
  const bool soil = quantity_ == GrainQuantity::Depth && !fluid_;
  return soil ? soilColour(static_cast<float>(p)) : heightColour(static_cast<float>(p));
}

std::vector<std::pair<Colour, std::string>> GrainColours::legend(const Borders& borders) const {
  std::vector<std::pair<Colour, std::string>> entries;
  const int count = subdomains(borders);
  if (quantity_ == GrainQuantity::Subdomain)
    for (int s = 0; s < std::min(count, 8); ++s) {
      std::string names = fmt::format("{}", s);
      if (count > s + 8) names += fmt::format(", {}{}", s + 8, count > s + 16 ? ", ..." : "");
      entries.emplace_back(subdomainColour(s), names);
    }
  if (quantity_ == GrainQuantity::Role) {
    entries.emplace_back(evenColour(), count == 2 ? "subdomain 0" : "even subdomain");
    if (count > 1) entries.emplace_back(oddColour(), count == 2 ? "subdomain 1" : "odd subdomain");
    if (count > 1) entries.emplace_back(spanningColour(), "spanning");
  }
  return entries;
}

std::vector<Colour> GrainColours::of(const output::StoredFrame& frame, const Borders& borders) const {
  std::vector<Colour> colours(frame.positions.size(), evenColour());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const base::Vec3f& p = frame.positions[i];
    if (hasRange()) {
      colours[i] = scaleColour((value(frame, i) - range_.low) / (range_.high - range_.low));
    } else if (quantity_ == GrainQuantity::Subdomain) {
      colours[i] = subdomainColour(numberOf(borders, subdomainAt(borders, p)));
    } else if (quantity_ == GrainQuantity::Role) {
      const std::array<int, 3> place = subdomainAt(borders, p);
      if (spans(borders, p, frame.radii[i]))
        colours[i] = spanningColour();
      else if ((place[0] + place[1] + place[2]) % 2)
        colours[i] = oddColour();
    }
  }
  return colours;
}

} // namespace grouser::render

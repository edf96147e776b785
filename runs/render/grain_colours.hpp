// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/frames_reader.hpp"
#include "runs/render/colour.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace grouser::render {

/// What the colour of a grain says.
enum class GrainQuantity {
  Depth,     ///< of its centre below the surface of the bed in the file's first frame [m]
  Speed,     ///< [m/s]
  Subdomain, ///< in which its centre lies
  Role,      ///< in a subdomain of even or odd place, or spanning: the sphere itself crosses a border
  White      ///< nothing
};

/// Of "depth", "speed", "subdomain", "role", "white"; throws base::InputError for any other word.
GrainQuantity grainQuantity(const std::string& word);

/// Where the borders between subdomains cross each axis [m], ascending; all empty: one subdomain.
using Borders = std::array<std::vector<double>, 3>;

/// Of "x=0.5" or "x=-1,0,1"; each word adds to its axis. Throws base::InputError.
Borders bordersOf(const std::vector<std::string>& words);

/// Place in the lattice of subdomains of the one that holds a point: a point on a border is in the upper one.
std::array<int, 3> subdomainAt(const Borders& borders, const base::Vec3f& p_W);
/// Whether a sphere crosses a border; touching it from outside is not crossing.
bool spans(const Borders& borders, const base::Vec3f& p_W, float radius);

/// The top of the bed over x and y, as the grains of one frame make it: the highest grain's top in square cells of four
/// radii, those without grains filled from their neighbours.
class BedTop {
public:
  BedTop() = default;
  explicit BedTop(const output::StoredFrame& frame);
  /// [m]; 0 where there are no grains at all.
  double height(double x, double y) const;

private:
  double xMin_ = 0, yMin_ = 0, edge_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<float> top_;
};

struct ValueRange {
  double low = 0, high = 1;
};

/// Colours grains; the same for all frames of a film.
class GrainColours {
public:
  /// `range` of depth or speed; without it, all but the lowest and highest hundredth of the values in `samples`.
  GrainColours(GrainQuantity quantity, const output::StoredFrame& first,
               const std::vector<output::StoredFrame>& samples, std::optional<ValueRange> range);

  GrainQuantity quantity() const { return quantity_; }
  bool hasRange() const { return quantity_ == GrainQuantity::Depth || quantity_ == GrainQuantity::Speed; }
  const ValueRange& range() const { return range_; }
  /// "depth [m]"
  std::string title() const;
  /// The colour at a place of the range, 0 to 1.
  Colour scaleColour(double place) const;
  /// Colours with the words that they stand for; empty where there is a range, or nothing to say.
  std::vector<std::pair<Colour, std::string>> legend(const Borders& borders) const;
  /// One colour a grain.
  std::vector<Colour> of(const output::StoredFrame& frame, const Borders& borders) const;

private:
  double value(const output::StoredFrame& frame, std::size_t grain) const;

  GrainQuantity quantity_;
  BedTop top_;
  ValueRange range_;
};

} // namespace grouser::render

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/frames_reader.hpp"
#include "runs/render/colour.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace grouser::render {

/// Meaning of the colour of a grain.
enum class GrainQuantity {
  Depth,     ///< depth of its centre below the bed surface of the first frame [m]
  Speed,     ///< [m/s]
  Subdomain, ///< subdomain of its centre
  Role,      ///< grain of an even or odd subdomain, or spanning (the sphere crosses a border)
  White      ///< all grains white
};

/// Parses "depth", "speed", "subdomain", "role", "white"; throws base::InputError for other words.
GrainQuantity grainQuantity(const std::string& word);

/// Positions of the borders between subdomains on each axis [m], ascending; all empty: one subdomain.
using Borders = std::array<std::vector<double>, 3>;

/// Parses "x=0.5" or "x=-1,0,1"; each word adds to its axis. Throws base::InputError.
Borders bordersOf(const std::vector<std::string>& words);

/// Lattice indices of the subdomain of a point; points on a border belong to the upper one.
std::array<int, 3> subdomainAt(const Borders& borders, const base::Vec3f& p_W);
/// Whether a sphere crosses a border; returns false if it only touches the border.
bool spans(const Borders& borders, const base::Vec3f& p_W, float radius);

/// Surface of the bed, from the grains of one frame: the highest grain top in square cells four radii wide; empty cells
/// are filled from their neighbours.
class BedTop {
public:
  BedTop() = default;
  explicit BedTop(const output::StoredFrame& frame);
  /// Height of the surface [m]; 0 without grains.
  double height(double x, double y) const;

private:
  double xMin_ = 0, yMin_ = 0, edge_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<float> top_;
};

struct ValueRange {
  double low = 0, high = 1;
};

/// Colours of grains, equal for all frames.
class GrainColours {
public:
  /// `range`: range of depth or speed; default: that of `samples` without the lowest and highest hundredth.
  GrainColours(GrainQuantity quantity, const output::StoredFrame& first,
               const std::vector<output::StoredFrame>& samples, std::optional<ValueRange> range);

  GrainQuantity quantity() const { return quantity_; }
  bool hasRange() const { return quantity_ == GrainQuantity::Depth || quantity_ == GrainQuantity::Speed; }
  const ValueRange& range() const { return range_; }
  /// Title of the colour scale: "depth [m]".
  std::string title() const;
  /// The colour at a position of the range, 0 to 1.
  Colour scaleColour(double place) const;
  /// Legend of discrete colours; empty for ranges and White.
  std::vector<std::pair<Colour, std::string>> legend(const Borders& borders) const;
  /// One colour per grain.
  std::vector<Colour> of(const output::StoredFrame& frame, const Borders& borders) const;

private:
  double value(const output::StoredFrame& frame, std::size_t grain) const;

  GrainQuantity quantity_;
  bool fluid_ = false;
  BedTop top_;
  ValueRange range_;
};

} // namespace grouser::render

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/render/colour.hpp"
#include "runs/render/image.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

/// Text and colour scales on a finished picture. Sizes are proportional to the height of the picture.
namespace grouser::render {

/// DejaVu Sans, which is embedded in the program at build time.
class Font {
public:
  Font();
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// Width of a line of text [pixels].
  double width(const std::string& text, double size) const;
  /// Draws dark ASCII text of `size` [pixels] starting at `x`, with its base line at `y`.
  void draw(Image& image, double x, double y, double size, const std::string& text) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// A line of text in the upper left corner.
void drawCaption(Image& image, const Font& font, const std::string& text);

/// A vertical colour scale at the right with round tick labels. `colours` from bottom to top, at the values `bottom`
/// and `top`; either may be the higher one.
void drawScale(Image& image, const Font& font, const std::string& title, double bottom, double top,
               const std::vector<Colour>& colours);

/// A scale bar of round length in the lower left corner, about a sixth of the picture wide. `perMetre`: pixels.
void drawLength(Image& image, const Font& font, double perMetre);

/// Legend of colours in the upper right corner.
void drawLegend(Image& image, const Font& font, const std::string& title,
                const std::vector<std::pair<Colour, std::string>>& entries);

/// About `count` round numbers in [low, high], ascending.
std::vector<double> ticks(double low, double high, int count);

} // namespace grouser::render

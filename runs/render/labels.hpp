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

/// Font DejaVu Sans, embedded in the program at build time.
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

/// Draws a line of text in the upper left corner.
void drawCaption(Image& image, const Font& font, const std::string& text);

/// Draws a vertical colour scale with round tick labels at the right. `colours`: from bottom to top. `bottom`, `top`:
/// values at the ends; either may be larger.
void drawScale(Image& image, const Font& font, const std::string& title, double bottom, double top,
               const std::vector<Colour>& colours);

/// Draws a scale bar of round length in the lower left corner, about 1/6 of the picture wide. `perMetre`: [pixels/m].
void drawLength(Image& image, const Font& font, double perMetre);

/// Draws a legend of colours in the upper right corner.
void drawLegend(Image& image, const Font& font, const std::string& title,
                const std::vector<std::pair<Colour, std::string>>& entries);

/// About `count` round numbers in [low, high], ascending.
std::vector<double> ticks(double low, double high, int count);

} // namespace grouser::render

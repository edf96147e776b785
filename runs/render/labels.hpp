// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/render/colour.hpp"
#include "runs/render/image.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

/// Words and colour scales on a finished picture. Sizes follow the picture's height.
namespace grouser::render {

/// DejaVu Sans, as Debian's fonts-dejavu-core installs it.
class Font {
public:
  /// Throws base::InputError with the remedy where the font is not there.
  Font();
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// Of a line of text [pixels].
  double width(const std::string& text, double size) const;
  /// Draws dark text of `size` [pixels] from `x` on, with its base line at `y`. Only ASCII.
  void draw(Image& image, double x, double y, double size, const std::string& text) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// A line of text in the upper left corner.
void drawCaption(Image& image, const Font& font, const std::string& text);

/// A vertical colour scale at the right, with round numbers at its ticks. `colours` run evenly from the bottom to the
/// top, where the values are `bottom` and `top`; either may be the higher one.
void drawScale(Image& image, const Font& font, const std::string& title, double bottom, double top,
               const std::vector<Colour>& colours);

/// A bar of a round length in the lower left corner, about a sixth of the picture wide. `perMetre`: pixels.
void drawLength(Image& image, const Font& font, double perMetre);

/// Colours and what they stand for, in the upper right corner.
void drawLegend(Image& image, const Font& font, const std::string& title,
                const std::vector<std::pair<Colour, std::string>>& entries);

/// Round numbers in [low, high], about `count` of them, ascending.
std::vector<double> ticks(double low, double high, int count);

} // namespace grouser::render

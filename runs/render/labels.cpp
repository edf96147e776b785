// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/labels.hpp"

#include <fmt/format.h>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

// The font is part of the program, so that labels do not depend on the fonts of the machine.
asm(".pushsection .rodata\n.global kGrouserLabelFont\n.hidden kGrouserLabelFont\n"
    "kGrouserLabelFont: .incbin \"" GROUSER_LABEL_FONT "\"\n.popsection");
extern "C" const unsigned char kGrouserLabelFont[];

namespace grouser::render {

namespace {

constexpr std::uint8_t kInk = 30;       ///< grey value of letters and lines, 0 to 255
constexpr double kPanelOpacity = 0.72;  ///< opacity of the white background of text [-]
constexpr double kTextShare = 1.0 / 38; ///< text height / picture height
constexpr double kSmallestText = 9;     ///< minimum text height [pixels]

double textSize(const Image& image) { return std::max(kSmallestText, image.height * kTextShare); }

void blend(Image& image, int x, int y, const std::uint8_t (&colour)[3], double share) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::uint8_t* p = &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(x))];
  for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(std::lround(p[c] * (1 - share) + colour[c] * share));
}

/// A translucent white panel with round corners over [left, right) x [top, bottom).
void panel(Image& image, double left, double top, double right, double bottom, double corner) {
  for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y)
    for (int x = static_cast<int>(left); x < static_cast<int>(right); ++x) {
      const double dx = std::max({left + corner - x, x - (right - 1 - corner), 0.0});
      const double dy = std::max({top + corner - y, y - (bottom - 1 - corner), 0.0});
      const double inside = std::clamp(corner + 0.5 - std::sqrt(dx * dx + dy * dy), 0.0, 1.0);
      blend(image, x, y, {255, 255, 255}, kPanelOpacity * inside);
    }
}

void fill(Image& image, double left, double top, double right, double bottom, const Colour& colour) {
  const std::array<std::uint8_t, 3> c = toSrgb(colour);
  for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y)
    for (int x = static_cast<int>(left); x < static_cast<int>(right); ++x) blend(image, x, y, {c[0], c[1], c[2]}, 1);
}

void line(Image& image, double left, double top, double right, double bottom) {
  for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y)
    for (int x = static_cast<int>(left); x < static_cast<int>(right); ++x) blend(image, x, y, {kInk, kInk, kInk}, 0.9);
}

} // namespace

struct Font::Data {
  stbtt_fontinfo info{};
};

Font::Font() : data_(std::make_unique<Data>()) {
  if (!stbtt_InitFont(&data_->info, kGrouserLabelFont, 0))
    throw std::runtime_error("the font of the labels is damaged: " GROUSER_LABEL_FONT " at build time");
}

Font::~Font() = default;

double Font::width(const std::string& text, double size) const {
  const double scale = double{stbtt_ScaleForPixelHeight(&data_->info, static_cast<float>(size))};
  double sum = 0;
  for (const char c : text) {
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&data_->info, c, &advance, &bearing);
    sum += advance * scale;
  }
  return sum;
}

void Font::draw(Image& image, double x, double y, double size, const std::string& text) const {
  const float scale = stbtt_ScaleForPixelHeight(&data_->info, static_cast<float>(size));
  for (const char c : text) {
    const double whole = std::floor(x);
    int width = 0, height = 0, left = 0, top = 0, advance = 0, bearing = 0;
    unsigned char* shape = stbtt_GetCodepointBitmapSubpixel(&data_->info, scale, scale, static_cast<float>(x - whole),
                                                            0, c, &width, &height, &left, &top);
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column)
        blend(image, static_cast<int>(whole) + left + column, static_cast<int>(std::lround(y)) + top + row,
              {kInk, kInk, kInk}, shape[row * width + column] / 255.0);
    stbtt_FreeBitmap(shape, nullptr);
    stbtt_GetCodepointHMetrics(&data_->info, c, &advance, &bearing);
    x += double{scale} * advance;
  }
}

void drawCaption(Image& image, const Font& font, const std::string& text) {
  const double size = textSize(image);
  panel(image, size, size, 2 * size + font.width(text, size), 2.5 * size, 0.4 * size);
  font.draw(image, 1.5 * size, 2.05 * size, size, text);
}

std::vector<double> ticks(double low, double high, int count) {
  const double rough = (high - low) / std::max(1, count), power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double s : {1.0, 2.0, 2.5, 5.0})
    if (s * power >= rough * (1 - 1e-9)) {
      step = s * power;
      break;
    }
  std::vector<double> places;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) places.push_back(k * step);
  return places;
}

void drawScale(Image& image, const Font& font, const std::string& title, double bottom, double top,
               const std::vector<Colour>& colours) {
  const double size = textSize(image), height = 11 * size, bar = size;
  const std::vector<double> places = ticks(std::min(bottom, top), std::max(bottom, top), 5);
  std::vector<std::string> texts;
  double widest = 0;
  for (const double place : places) {
    texts.push_back(fmt::format("{:.4g}", std::fabs(place) < 1e-12 ? 0.0 : place));
    widest = std::max(widest, font.width(texts.back(), size));
  }
  const double inner = std::max(font.width(title, size), bar + 0.8 * size + widest);
  const double right = image.width - size, left = right - inner - size, head = size;
  panel(image, left, head, right, head + height + 3.2 * size, 0.4 * size);
  font.draw(image, left + 0.5 * size, head + 1.1 * size, size, title);
  const double x = left + 0.5 * size, y = head + 2.3 * size;
  for (int row = 0; row < static_cast<int>(height); ++row) {
    const double place = 1 - (row + 0.5) / std::floor(height);
    const auto i = static_cast<std::size_t>(place * static_cast<double>(colours.size()));
    fill(image, x, y + row, x + bar, y + row + 1, colours[std::min(i, colours.size() - 1)]);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double at = std::floor(y + height * (top - places[i]) / (top - bottom));
    line(image, x + bar, at - 0.5, x + bar + 0.35 * size, at + std::max(1.0, size / 16));
    font.draw(image, x + bar + 0.6 * size, at + 0.33 * size, size, texts[i]);
  }
}

void drawLength(Image& image, const Font& font, double perMetre) {
  const double size = textSize(image), most = image.width / 6.0 / perMetre;
  double length = std::pow(10, std::floor(std::log10(most)));
  for (const double step : {5.0, 2.0})
    if (step * length <= most) {
      length *= step;
      break;
    }
  const std::string text = fmt::format("{:g} m", length);
  const double bar = length * perMetre, inner = std::max(bar, font.width(text, size));
  const double bottom = image.height - size, top = bottom - 2.4 * size, x = 1.5 * size;
  panel(image, size, top, 2 * size + inner, bottom, 0.4 * size);
  font.draw(image, x, top + 1.05 * size, size, text);
  const double y = bottom - 0.7 * size, thick = std::max(2.0, size / 8);
  line(image, x, y, x + bar, y + thick);
  for (const double end : {x, x + bar - thick}) line(image, end, y - 0.3 * size, end + thick, y + 0.3 * size + thick);
}

void drawLegend(Image& image, const Font& font, const std::string& title,
                const std::vector<std::pair<Colour, std::string>>& entries) {
  const double size = textSize(image), pitch = 1.5 * size;
  double inner = font.width(title, size);
  for (const auto& [colour, text] : entries) inner = std::max(inner, 1.6 * size + font.width(text, size));
  const double right = image.width - size, left = right - inner - size, head = size;
  panel(image, left, head, right, head + (1.4 + 1.5 * static_cast<double>(entries.size())) * size + 0.4 * size,
        0.4 * size);
  double y = head + 1.1 * size;
  font.draw(image, left + 0.5 * size, y, size, title);
  for (const auto& [colour, text] : entries) {
    y += pitch;
    const double x = left + 0.5 * size;
    line(image, x - 1, y - 0.9 * size - 1, x + size + 1, y + 0.1 * size + 1);
    fill(image, x, y - 0.9 * size, x + size, y + 0.1 * size, colour);
    font.draw(image, x + 1.6 * size, y - 0.05 * size, size, text);
  }
}

} // namespace grouser::render

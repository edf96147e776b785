// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// PNG files for tests, valid and damaged.
namespace grouser::pngs {

using Bytes = std::string;

inline void append32(Bytes& to, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<char>(v >> shift));
}

inline std::uint32_t crc32(const Bytes& bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const unsigned char byte : bytes) {
    crc ^= byte;
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1) ? 0xEDB88320u : 0);
  }
  return ~crc;
}

inline void appendChunk(Bytes& png, const Bytes& type, const Bytes& data) {
  append32(png, static_cast<std::uint32_t>(data.size()));
  png += type + data;
  append32(png, crc32(type + data));
}

enum ColourType { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

inline Bytes headerOf(int columns, int rows, int bits, ColourType colour, bool interlaced = false) {
  Bytes header;
  append32(header, columns), append32(header, rows);
  return header + Bytes{static_cast<char>(bits), static_cast<char>(colour), 0, 0, static_cast<char>(interlaced)};
}

/// An uncompressed PNG as in its specification (ISO/IEC 15948). `chunks` precede the pixels.
inline Bytes pngOf(const Bytes& header, const Bytes& scanlines, const Bytes& chunks = "") {
  const auto length = static_cast<std::uint16_t>(scanlines.size());
  Bytes zlib{0x78,
             0x01,
             0x01,
             static_cast<char>(length),
             static_cast<char>(length >> 8),
             static_cast<char>(~length),
             static_cast<char>(~length >> 8)};
  std::uint32_t a = 1, b = 0; // Adler-32
  for (const unsigned char byte : scanlines) a = (a + byte) % 65521, b = (b + a) % 65521;
  zlib += scanlines;
  append32(zlib, b << 16 | a);

  Bytes file = "\x89PNG\r\n\x1a\n";
  appendChunk(file, "IHDR", header);
  file += chunks;
  appendChunk(file, "IDAT", zlib);
  appendChunk(file, "IEND", "");
  return file;
}

/// `samples` row by row, channels side by side.
inline Bytes png(int columns, int rows, int bits, ColourType colour, const std::vector<int>& samples) {
  Bytes scanlines;
  const std::size_t perRow = samples.size() / rows;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    if (s % perRow == 0) scanlines.push_back(0); // no filter
    if (bits == 16) scanlines.push_back(static_cast<char>(samples[s] >> 8));
    scanlines.push_back(static_cast<char>(samples[s]));
  }
  return pngOf(headerOf(columns, rows, bits, colour), scanlines);
}

} // namespace grouser::pngs

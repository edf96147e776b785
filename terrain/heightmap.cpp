// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/heightmap.hpp"

#include "base/error.hpp"
#include "base/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

// Only this file compiles the decoder. It excludes vector code, whose JPEG transform rounds differently, and formats
// without a way to detect truncation.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_SIMD
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#include <stb/stb_image.h>

namespace grouser::terrain {

namespace {

using base::InputError;

constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

/// Deleter for pixels allocated by the decoder.
struct FreePixels {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

std::vector<stbi_uc> readFile(const std::filesystem::path& file) {
  const std::string bytes = base::readInput(file, "give the path of a PNG picture (8 or 16 bit)");
  return {bytes.begin(), bytes.end()};
}

constexpr stbi_uc kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

bool isPng(const std::vector<stbi_uc>& bytes) {
  return bytes.size() >= std::size(kSignature) &&
         std::equal(std::begin(kSignature), std::end(kSignature), bytes.begin());
}

/// Reads four bytes, big-endian.
std::uint32_t wordAt(const std::vector<stbi_uc>& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t k = at; k < at + 4; ++k) word = word << 8 | bytes[k];
  return word;
}

// Offsets in a PNG file; its first chunk must be the header, IHDR.
constexpr std::size_t kHeaderTypeAt = 12, kWidthAt = 16, kHeightAt = 20, kDepthAt = 24, kColourTypeAt = 25,
                      kInterlacedAt = 28;

std::string chunkType(const std::vector<stbi_uc>& bytes, std::size_t at) {
  std::string type(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                   bytes.begin() + static_cast<std::ptrdiff_t>(at + 4));
  std::replace_if(
      type.begin(), type.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
  return type;
}

bool isPngWithoutHeader(const std::vector<stbi_uc>& bytes) {
  return isPng(bytes) && (bytes.size() < kWidthAt || chunkType(bytes, kHeaderTypeAt) != "IHDR");
}

/// Columns and rows in a PNG header (the decoder gives no reason for rejecting large ones); 0 for other files.
std::pair<std::int64_t, std::int64_t> sizeOfPng(const std::vector<stbi_uc>& bytes) {
  if (bytes.size() < kDepthAt || !isPng(bytes)) return {0, 0};
  constexpr std::uint32_t kMax = 0x7FFFFFFF; // the format's limit
  return {std::min(wordAt(bytes, kWidthAt), kMax), std::min(wordAt(bytes, kHeightAt), kMax)};
}

/// CRC-32 of ISO/IEC 15948, annex D.
std::uint32_t crcOf(const stbi_uc* bytes, std::size_t count) {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    table[n] = n;
    for (int k = 0; k < 8; ++k) table[n] = table[n] >> 1 ^ ((table[n] & 1) ? 0xEDB88320u : 0u);
  }
  std::uint32_t crc = ~std::uint32_t{0};
  for (std::size_t k = 0; k < count; ++k) crc = table[(crc ^ bytes[k]) & 0xFFu] ^ crc >> 8;
  return ~crc;
}

/// Reason of the decoder's last failure, as " (bad file)"; empty if unknown.
std::string decodersReason() {
  const char* reason = stbi_failure_reason();
  return reason && *reason ? fmt::format(" ({})", reason) : "";
}

/// Chunks of a PNG that determine its pixels, besides its header.
struct PngPixels {
  std::vector<char> stream;      ///< data of all IDAT chunks, in zlib's format
  std::size_t colours{0};        ///< entries of the palette
  std::size_t transparencyAt{0}; ///< offset of the type of chunk tRNS; 0: no such chunk
};

/// Size of the uncompressed pixels of a PNG: a filter byte and the samples of each row; seven passes if interlaced.
std::int64_t unpackedBytes(const std::vector<stbi_uc>& bytes) {
  struct Part {
    std::int64_t x, y, dx, dy; ///< first column and row, and increments
  };
  constexpr Part kParts[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                             {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}, {0, 0, 1, 1}};
  constexpr int kSamples[] = {1, 0, 3, 1, 2, 0, 4}; // samples per pixel, by colour type
  const auto [columns, rows] = sizeOfPng(bytes);
  const bool interlaced = bytes[kInterlacedAt] != 0;
  std::int64_t total = 0;
  for (int k = interlaced ? 0 : 7; k < (interlaced ? 7 : 8); ++k) {
    const Part& p = kParts[k];
    const std::int64_t across = (columns - p.x + p.dx - 1) / p.dx, down = (rows - p.y + p.dy - 1) / p.dy;
    if (across > 0) total += down * (1 + (across * kSamples[bytes[kColourTypeAt]] * bytes[kDepthAt] + 7) / 8);
  }
  return total;
}

/// Changes the colour type to grey, so that the decoder returns palette indices; otherwise it would copy colours beyond
/// the palette from uninitialised memory.
std::string paletteFault(std::vector<stbi_uc> bytes, const PngPixels& pixels) {
  constexpr int kGrey = 0, kPalette = 3;
  const int most = (1 << bytes[kDepthAt]) - 1;
  if (bytes[kColourTypeAt] != kPalette || pixels.colours > static_cast<std::size_t>(most)) return {};
  bytes[kColourTypeAt] = kGrey;
  if (pixels.transparencyAt > 0)
    bytes[pixels.transparencyAt] = 'x'; // renames the palette chunk, which is invalid for grey
  int columns = 0, rows = 0, channels = 0;
  const std::unique_ptr<stbi_uc, FreePixels> levels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &columns, &rows, &channels, 1));
  if (!levels) return decodersReason();
  const stbi_uc* const end = levels.get() + static_cast<std::ptrdiff_t>(columns) * rows;
  const std::size_t highest =
      static_cast<std::size_t>(*std::max_element<const stbi_uc*>(levels.get(), end)) * most / 255;
  if (highest < pixels.colours) return {};
  return fmt::format(" (a pixel has colour {}, the palette ends at {})", highest,
                     static_cast<std::int64_t>(pixels.colours) - 1);
}

/// Compares the stream with its Adler-32 checksum (RFC 1950) and with the header.
std::string pixelFault(const std::vector<stbi_uc>& bytes, const PngPixels& pixels) {
  if (pixels.stream.size() < 4) return " (no pixels)";
  int count = 0;
  const std::unique_ptr<char, FreePixels> unpacked(
      stbi_zlib_decode_malloc(pixels.stream.data(), static_cast<int>(pixels.stream.size()), &count));
  constexpr std::uint32_t kPrime = 65521;
  std::uint32_t a = 1, b = 0;
  for (int k = 0; unpacked && k < count; ++k) {
    a = (a + static_cast<unsigned char>(unpacked.get()[k])) % kPrime;
    b = (b + a) % kPrime;
  }
  const std::vector<stbi_uc> tail(pixels.stream.end() - 4, pixels.stream.end());
  if (!unpacked || (b << 16 | a) != wordAt(tail, 0)) return " (wrong checksum of the pixels)";
  if (const std::int64_t announced = unpackedBytes(bytes); count != announced)
    return fmt::format(" ({} bytes of pixels, the header specifies {})", count, announced);
  return paletteFault(bytes, pixels);
}

/// Error of a damaged PNG, since the decoder verifies no checksums: " (wrong checksum of chunk IDAT at byte 41)". Empty
/// for valid files and other formats. The decoder must have accepted the header.
std::string pngFault(const std::vector<stbi_uc>& bytes) {
  constexpr std::size_t kAround = 12; // length, type and checksum of a chunk
  if (!isPng(bytes)) return {};
  PngPixels pixels;
  for (std::size_t at = std::size(kSignature); at + kAround <= bytes.size();) {
    const std::size_t length = wordAt(bytes, at), from = at + 8;
    const std::string type = chunkType(bytes, at + 4);
    if (length > bytes.size() - at - kAround)
      return fmt::format(" (chunk {} at byte {} specifies {} bytes, more than follow)", type, at, length);
    if (crcOf(&bytes[at + 4], length + 4) != wordAt(bytes, from + length))
      return fmt::format(" (wrong checksum of chunk {} at byte {})", type, at);
    if (type == "IDAT")
      pixels.stream.insert(pixels.stream.end(), bytes.begin() + static_cast<std::ptrdiff_t>(from),
                           bytes.begin() + static_cast<std::ptrdiff_t>(from + length));
    if (type == "PLTE") pixels.colours = length / 3;
    if (type == "tRNS") pixels.transparencyAt = at + 4;
    if (type == "IEND") return pixelFault(bytes, pixels);
    at += length + kAround;
  }
  return " (no end mark)";
}

/// True if the end-of-image marker is missing: the decoder silently fills the missing part of a JPEG with grey.
bool isCutShort(const std::vector<stbi_uc>& bytes) {
  const std::size_t n = bytes.size();
  const bool jpeg = n >= 2 && bytes[0] == 0xFF && bytes[1] == 0xD8;
  return jpeg && !(bytes[n - 2] == 0xFF && bytes[n - 1] == 0xD9);
}

/// Brightness of one pixel. Uses integers below 2^31 and one correctly rounded division; grey keeps its value exactly.
template <class Channel> double brightness(const Channel* pixel, int channels, int white) {
  const bool grey = channels <= 2;
  const int r = pixel[0], g = grey ? r : pixel[1], b = grey ? r : pixel[2];
  return static_cast<double>(2126 * r + 7152 * g + 722 * b) / (10000.0 * white);
}

template <class Channel>
std::vector<double> brightnessOf(const Channel* pixels, std::size_t count, int channels, int white) {
  std::vector<double> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = brightness(pixels + i * channels, channels, white);
  return result;
}

template <class Channel> bool isTransparent(const Channel* pixels, std::size_t count, int channels, int white) {
  for (std::size_t i = 0; channels % 2 == 0 && i < count; ++i)
    if (pixels[(i + 1) * static_cast<std::size_t>(channels) - 1] != white) return true;
  return false;
}

template <class Channel> bool isColour(const Channel* pixels, std::size_t count, int channels) {
  for (std::size_t i = 0; channels > 2 && i < count; ++i) {
    const Channel* p = pixels + i * channels;
    if (p[0] != p[1] || p[0] != p[2]) return true;
  }
  return false;
}

} // namespace

Heightmap loadHeightmap(const std::filesystem::path& file) {
  const std::vector<stbi_uc> bytes = readFile(file);
  const auto fail = [&](const std::string& cause) -> void { throw InputError(file.string() + ": " + cause); };
  if (bytes.empty()) fail("the file is empty; give a PNG picture (8 or 16 bit)");
  if (bytes.size() > 0x7FFFFFFF) fail("larger than 2 GiB; give a smaller picture");
  const int size = static_cast<int>(bytes.size());

  if (isPngWithoutHeader(bytes))
    fail("the picture is damaged or truncated (its first chunk is not IHDR); save or copy it again");
  if (const auto [columns, rows] = sizeOfPng(bytes); columns * rows > kMaxPixels)
    fail(fmt::format("{} x {} pixels; at most 2^28 are supported, give a smaller picture", columns, rows));

  Heightmap map;
  map.file = file;
  int channels = 0;
  if (!stbi_info_from_memory(bytes.data(), size, &map.columns, &map.rows, &channels))
    fail("not a picture of a known format; give a PNG (8 or 16 bit) or a JPEG");
  const std::string dimensions = fmt::format("{} x {} pixels", map.columns, map.rows);
  if (map.columns < 2 || map.rows < 2)
    fail(dimensions + "; a height-map needs at least 2 x 2, since pixels are points at the corners");
  if (static_cast<std::int64_t>(map.columns) * map.rows > kMaxPixels)
    fail(dimensions + "; at most 2^28 are supported, give a smaller picture");

  const std::size_t count = static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
  const bool deep = stbi_is_16_bit_from_memory(bytes.data(), size);
  const std::string damage = isCutShort(bytes) ? " (no end mark)" : pngFault(bytes);
  const auto decode = [&](auto load, int white) {
    auto* const decoded = load(bytes.data(), size, &map.columns, &map.rows, &channels, 0);
    const std::unique_ptr<std::remove_pointer_t<decltype(decoded)>, FreePixels> pixels(decoded);
    if (!pixels || !damage.empty())
      fail(fmt::format("the header specifies {}, but the picture is damaged or truncated{}; save or copy it again",
                       dimensions, damage.empty() ? decodersReason() : damage));
    map.colour = isColour(pixels.get(), count, channels);
    map.transparent = isTransparent(pixels.get(), count, channels, white);
    map.brightness = brightnessOf(pixels.get(), count, channels, white);
  };
  map.bits = deep ? 16 : 8;
  if (deep)
    decode(stbi_load_16_from_memory, 65535);
  else
    decode(stbi_load_from_memory, 255);
  return map;
}

HeightField heightFieldOf(const Heightmap& map, const HeightmapPlacement& placement) {
  const auto fail = [&](const std::string& cause) -> void { throw InputError(map.file.string() + ": " + cause); };
  const auto& p = placement;
  if (!(p.sizeX > 0 && p.sizeY > 0 && std::isfinite(p.sizeX) && std::isfinite(p.sizeY)))
    fail(fmt::format("size = [{}, {}] m; both must be positive and finite: the lengths of the picture in x and y",
                     p.sizeX, p.sizeY));
  if (!(std::isfinite(p.black) && std::isfinite(p.white)))
    fail(fmt::format("height_range = [{}, {}] m; both must be finite: the heights of black and of white", p.black,
                     p.white));

  std::vector<double> heights(map.brightness.size());
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const std::size_t node = static_cast<std::size_t>(map.rows - 1 - row) * map.columns + column;
      const double b = map.at(column, row);
      heights[node] = (1 - b) * p.black + b * p.white;
    }
  return HeightField({0, p.sizeX, -p.sizeY / 2, p.sizeY / 2}, map.columns, map.rows, std::move(heights),
                     p.interpolation);
}

} // namespace grouser::terrain

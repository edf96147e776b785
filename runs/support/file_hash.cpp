// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/file_hash.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <vector>

namespace grouser::support {

namespace {

void addBytes(base::StateHash& hash, std::string_view bytes) {
  for (const char c : bytes) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

/// Remainders of all bytes for crc32().
constexpr std::array<std::uint32_t, 256> kRemainders = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    table[byte] = byte;
    for (int bit = 0; bit < 8; ++bit) table[byte] = table[byte] >> 1 ^ (table[byte] & 1 ? 0xEDB88320u : 0u);
  }
  return table;
}();

} // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  std::uint32_t remainder = ~before;
  for (const char c : bytes)
    remainder = kRemainders[(remainder ^ static_cast<unsigned char>(c)) & 255] ^ remainder >> 8;
  return ~remainder;
}

std::string hashOfText(std::string_view text) {
  base::StateHash hash;
  addBytes(hash, text);
  return hash.hex();
}

std::string hashOfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw base::InputError(fmt::format("{}: cannot be read", path.string()));
  base::StateHash hash;
  std::vector<char> block(std::size_t{1} << 20);
  do {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    addBytes(hash, {block.data(), static_cast<std::size_t>(file.gcount())});
  } while (file);
  return hash.hex();
}

} // namespace grouser::support

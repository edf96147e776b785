// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/file_hash.hpp"

#include "base/error.hpp"
#include "base/hash.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <vector>

namespace grouser::support {

namespace {

void addBytes(base::StateHash& hash, std::string_view bytes) {
  for (const char c : bytes) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

} // namespace

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

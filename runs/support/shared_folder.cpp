// SPDX-License-Identifier: BSD-3-Clause
#include "runs/support/shared_folder.hpp"

#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace grouser::support {

namespace fs = std::filesystem;

namespace {

constexpr auto kPatience = std::chrono::seconds(5); ///< some file systems show new files to other hosts with a delay
constexpr auto kLook = std::chrono::milliseconds(20);

bool reads(const fs::path& file, const std::string& words) {
  std::ifstream stream(file, std::ios::binary);
  return stream && std::string(std::istreambuf_iterator<char>(stream), {}) == words;
}

} // namespace

std::optional<int> rankNotSeeing(const fs::path& folder, const base::Comm& comm) {
  if (comm.alone()) return std::nullopt;
  // A unique name, which no file system has cached as missing, and unique contents.
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  const std::string words = comm.broadcast(fmt::format("{:x}-{:x}", now, ::getpid()));
  const fs::path sign = folder / (".seen-by-all-ranks-" + words);
  bool seen = true;
  if (comm.first()) {
    try {
      writeTextFile(sign, words, "results");
    } catch (const std::exception&) {
      seen = false;
    }
  }
  const bool written = comm.sumOf(seen ? 0 : 1) == 0;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (written && !(seen = reads(sign, words)) && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(kLook);
  const std::vector<char> all = comm.gatherValue<char>(written && seen ? 1 : 0);
  std::error_code error;
  if (comm.first()) fs::remove(sign, error);
  const auto missing = std::find(all.begin(), all.end(), 0);
  return missing == all.end() ? std::nullopt : std::optional(static_cast<int>(missing - all.begin()));
}

} // namespace grouser::support

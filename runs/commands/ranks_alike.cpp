// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/ranks_alike.hpp"

#include "base/error.hpp"
#include "runs/support/build_info.hpp"
#include "runs/simulation/checkpoint.hpp"
#include "runs/support/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace grouser::commands {

namespace fs = std::filesystem;

namespace {

constexpr auto kPatience = std::chrono::seconds(5); ///< for a file system that tells other hosts with a delay
constexpr auto kLook = std::chrono::milliseconds(20);

bool reads(const fs::path& file, const std::string& words) {
  std::ifstream stream(file, std::ios::binary);
  return stream && std::string(std::istreambuf_iterator<char>(stream), {}) == words;
}

} // namespace

void requireSameCommand(const std::string& command, const base::Comm& comm) {
  if (comm.alone()) return;
  const auto all = comm.gatherAll(std::vector<char>(command.begin(), command.end()));
  for (std::size_t r = 1; r < all.size(); ++r)
    if (all[r] != all[0])
      throw base::InputError(
          fmt::format("rank {} was told to do \"{}\", rank 0 \"{}\"; start all ranks with the same words", r,
                      std::string(all[r].begin(), all[r].end()), std::string(all[0].begin(), all[0].end())));
}

void requireAlike(const scene::Scene& scene, const std::string& commandLine, const base::Comm& comm) {
  if (comm.alone()) return;
  const support::BuildInfo build = support::buildInfo();
  const std::pair<const char*, std::string> facts[] = {
      {"program (version, commit, compiler, hash of its file)",
       fmt::format("{}, {}, {}, {}", build.version, build.commit, build.compiler, support::programHash())},
      {"scene", scene::resolvedToml(scene)},
      {"files that the scene names", simulation::inputsOf(scene)},
      {"command line", commandLine.substr(std::min(commandLine.find(' '), commandLine.size()))},
  };
  for (const auto& [what, mine] : facts) {
    const auto all = comm.gatherAll(std::vector<char>(mine.begin(), mine.end()));
    for (std::size_t r = 1; r < all.size(); ++r) {
      if (all[r] == all[0]) continue;
      const std::string first(all[0].begin(), all[0].end()), other(all[r].begin(), all[r].end());
      const bool brief = first.size() < 200 && other.size() < 200;
      throw base::InputError(fmt::format("{}: rank {} has another {} than rank 0{}; start all ranks with the same "
                                         "program, files and words",
                                         scene.file.string(), r, what,
                                         brief ? fmt::format(" ({} beside {})", other, first) : ""));
    }
  }
}

std::optional<int> rankThatMisses(const fs::path& folder, const base::Comm& comm) {
  if (comm.alone()) return std::nullopt;
  // A name that no file system remembers as missing, and words that no other file holds.
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  const std::string words = comm.broadcast(fmt::format("{:x}-{:x}", now, ::getpid()));
  const fs::path sign = folder / (".seen-by-all-ranks-" + words);
  bool seen = true;
  if (comm.first()) {
    try {
      support::writeTextFile(sign, words, "results");
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

} // namespace grouser::commands

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/ranks_alike.hpp"

#include "base/error.hpp"
#include "runs/support/build_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace grouser::commands {

void requireSameCommand(const std::string& command, const base::Comm& comm) {
  if (comm.alone()) return;
  const auto all = comm.gatherAll(std::vector<char>(command.begin(), command.end()));
  for (std::size_t r = 1; r < all.size(); ++r)
    if (all[r] != all[0])
      throw base::InputError(
          fmt::format("rank {} was started with \"{}\", rank 0 with \"{}\"; start all ranks with the same command line",
                      r, std::string(all[r].begin(), all[r].end()), std::string(all[0].begin(), all[0].end())));
}

namespace {

struct Fact {
  std::string what, mine;
};

Fact program() {
  const support::BuildInfo build = support::buildInfo();
  return {"program (version, commit, compiler, hash of its file)",
          fmt::format("{}, {}, {}, {}", build.version, build.commit, build.compiler, support::programHash())};
}

/// Command line without the program's name.
Fact words(const std::string& commandLine) {
  return {"command line", commandLine.substr(std::min(commandLine.find(' '), commandLine.size()))};
}

/// `who`: first word of the message.
void requireSame(const std::string& who, const std::vector<Fact>& facts, const base::Comm& comm) {
  if (comm.alone()) return;
  for (const Fact& fact : facts) {
    const auto all = comm.gatherAll(std::vector<char>(fact.mine.begin(), fact.mine.end()));
    for (std::size_t r = 1; r < all.size(); ++r) {
      if (all[r] == all[0]) continue;
      const std::string first(all[0].begin(), all[0].end()), other(all[r].begin(), all[r].end());
      const bool brief = first.size() < 200 && other.size() < 200;
      throw base::InputError(fmt::format(
          "{}: rank {} has a different {} from rank 0{}; start all ranks with the same program, files and command line",
          who, r, fact.what, brief ? fmt::format(" ({} instead of {})", other, first) : ""));
    }
  }
}

} // namespace

void requireAlike(const setup::Provenance& provenance, const std::string& commandLine, const base::Comm& comm) {
  if (comm.alone()) return;
  requireSame(
      provenance.file.string(),
      {program(), {"scene", provenance.resolved}, {"set of input files", provenance.inputs}, words(commandLine)}, comm);
}

void requireSameWords(const std::string& command, const std::string& commandLine, const base::Comm& comm) {
  if (comm.alone()) return;
  requireSame(command, {program(), words(commandLine)}, comm);
}

} // namespace grouser::commands

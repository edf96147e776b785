// SPDX-License-Identifier: BSD-3-Clause
#include "base/comm.hpp"
#include "base/cpu_threads.hpp"
#include "base/error.hpp"
#include "base/name_fault.hpp"
#include "runs/commands/command_entry.hpp"
#include "runs/commands/manual.hpp"
#include "runs/commands/ranks_alike.hpp"
#include "runs/commands/run_scene.hpp"
#include "runs/support/build_info.hpp"
#include "runs/support/failure.hpp"
#include "runs/support/locations.hpp"
#include "runs/support/option_checks.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/shell_word.hpp"
#include "runs/support/stop_signals.hpp"

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace grouser;

/// Opens closed standard streams. Otherwise the next opened file would get the descriptor of such a stream and receive
/// its output. Output to a closed stderr is lost; printing results to a closed stdout is an error.
void occupyStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

/// Waiting OpenMP threads spin for milliseconds by default, which makes a step many times slower on a machine that also
/// runs other programs. The OpenMP library reads its settings when it is loaded, so the program restarts itself with a
/// short spin time, unless the user has set these environment variables.
void waitBriefly(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") || std::getenv("OMP_WAIT_POLICY")) return;
  setenv("GOMP_SPINCOUNT", "5000", 1);
  base::hideInvalidOmpNumThreads();
  base::unbindFirstThread();
  execv("/proc/self/exe", argv); // returns only on failure: then use the default
}

/// Prints the error and ends all ranks. The other ranks wait two seconds, so that the first rank prints an error that
/// all ranks have found, and then ends them.
int fail(const base::Ranks& ranks, support::FailureKind kind, const std::string& message) {
  const int code = support::exitCode(kind);
  std::fflush(stdout);
  if (!ranks.comm().first()) sleep(2);
  const std::string who = ranks.comm().alone() ? "" : fmt::format("rank {}: ", ranks.comm().rank());
  std::fputs(fmt::format("grouser: error: {}{}\n", who, base::escaped(message)).c_str(),
             stderr); // does not throw if stderr cannot be written
  std::fflush(stderr);
  ranks.abort(code);
  return code;
}

/// True if all output was written.
bool printedAll() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.good();
}

void addCommands(CLI::App& app, const std::vector<commands::CommandEntry>& all,
                 const commands::Invocation& invocation) {
  for (const commands::CommandEntry& command : all) {
    command.add(app, invocation);
    if (command.ranks != commands::RankUse::refused) continue;
    app.get_subcommand(command.name)->preparse_callback([command, comm = invocation.ranks.comm()](std::size_t) {
      if (!comm.alone())
        throw base::InputError(fmt::format("grouser {} does not support MPI ({} ranks); start it without mpirun{}",
                                           command.name, comm.size(), command.insteadOfRanks));
    });
  }
}

int failToPrint(const base::Ranks& ranks) {
  return fail(ranks, support::FailureKind::notWritten, "cannot write to standard output; is the disk full?");
}

/// Continues a branch from its own checkpoint, instead of the checkpoint where it began.
void resumeFrom(const std::filesystem::path& checkpoint, std::vector<std::string>& words) {
  const auto at = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return word == "--resume" || word.starts_with("--resume=");
  });
  if (at == words.end()) return;
  if (*at == "--resume" && at + 1 != words.end() && !(at + 1)->starts_with("-")) words.erase(at + 1);
  *at = "--resume";
  words.insert(at + 1, checkpoint.string());
}

/// Command that resumes the stopped command, or repeats it if there is no checkpoint.
std::string nextCommand(const CLI::App& app, std::vector<std::string> words, const base::Ranks& ranks,
                        const support::Stopped& stopped) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  const bool resumes =
      stopped.left() == support::Stopped::Left::work && command->get_option_no_throw("--resume") != nullptr;
  const auto has = [&](const std::string& option) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return word == option || word.starts_with(option + "="); });
  };
  if (resumes) std::erase(words, "--force");
  if (resumes && !has("--resume")) words.emplace_back("--resume");
  if (const auto* branch = dynamic_cast<const commands::StoppedBranch*>(&stopped))
    resumeFrom(branch->checkpoint(), words);
  // The results of the stopped command prevent its repetition without --force.
  const bool isInTheWay = !resumes && stopped.left() == support::Stopped::Left::work;
  if (isInTheWay && command->get_option_no_throw("--force") && !has("--force")) words.emplace_back("--force");
  if (!ranks.comm().alone()) words.insert(words.begin(), {"mpirun", "-np", std::to_string(ranks.comm().size())});
  return fmt::format("{} with: {}", resumes ? "resume" : "start again", support::shellLine(words));
}

/// Returns true for commands that run on the first rank only, and for unknown commands.
bool isForFirstRank(const std::string& word, const std::vector<commands::CommandEntry>& all) {
  for (const commands::CommandEntry& command : all)
    if (command.name == word) return command.ranks != commands::RankUse::shared;
  return true;
}

/// Command that must be the same on all ranks: "run", "bench bed".
std::string commandOf(const std::vector<std::string>& words) {
  const std::string command = words.size() > 1 ? words[1] : "";
  return command == "bench" && words.size() > 2 ? command + " " + words[2] : command;
}

/// Parses the command line and runs the command, on each rank; throws all errors.
void parseAndRun(CLI::App& app, int argc, char** argv, const base::Ranks& ranks) {
  const std::vector<std::string> words(argv, argv + argc);
  const std::vector<commands::CommandEntry> all = commands::allCommands();
  if (ranks.comm().first()) support::requireShareFolder();
  addCommands(app, all, {ranks, support::shellLine(words)});
  support::refuseOptionsAsValues(app);
  commands::requireSameCommand(commandOf(words), ranks.comm());
  if (!ranks.comm().first() && argc > 1 && isForFirstRank(words[1], all)) return; // rank 0 ends all ranks on failure
  if (const std::string unknown = support::unknownCommand(app, argc, argv); !unknown.empty())
    throw base::InputError(unknown);
  app.parse(argc, argv);
}

} // namespace

int main(int argc, char** argv) {
  occupyStandardStreams();
  waitBriefly(argv);
  // A file that exceeds the size limit then causes an error message, like a full disk, instead of a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGCHLD, SIG_DFL); // some supervisors ignore SIGCHLD, which loses the exit codes of child processes
  const base::Ranks ranks(argc, argv);
  // Only the first rank prints.
  if (!ranks.comm().first() && !std::freopen("/dev/null", "w", stdout))
    return support::exitCode(support::FailureKind::stray);
  CLI::App app("grouser simulates tracked vehicles on soil and computes error bars for its results.", "grouser");
  app.formatter(commands::helpFormatter());
  app.require_subcommand(1);
  app.set_version_flag("--version", support::versionText());
  app.footer(
      "Exit codes: 0 success, 1 internal error, 2 invalid input, 3 unsound simulation or results that could not "
      "be written, 4 device or memory error, 129, 130, 138 and 143 stopped by SIGHUP, SIGINT, SIGUSR1 "
      "and SIGTERM.\nSettled beds and sphere sets are cached in $GROUSER_CACHE (default: $XDG_CACHE_HOME/grouser or "
      "~/.cache/grouser), up to $GROUSER_CACHE_GIB GiB (default: 2).");
  try {
    parseAndRun(app, argc, argv, ranks);
    return printedAll() ? 0 : failToPrint(ranks);
  } catch (const CLI::Success& e) {
    const int code = app.exit(e); // --help and --version
    return printedAll() ? code : failToPrint(ranks);
  } catch (const CLI::ParseError& e) {
    return fail(ranks, support::FailureKind::input,
                fmt::format("{}{}; see grouser --help, or grouser COMMAND --help", e.what(),
                            support::nearestOptionHint(app, argc, argv)));
  } catch (const support::Stopped& e) {
    std::fflush(stdout);
    const std::string next = nextCommand(app, {argv, argv + argc}, ranks, e);
    if (ranks.comm().first()) support::printStderr("grouser: {}; {}\n", e.what(), next);
    return 128 + e.signal();
  } catch (...) {
    using Kind = support::FailureKind;
    const support::Failure failure = support::failureOf(std::current_exception());
    if ((failure.kind == Kind::stray || failure.kind == Kind::notWritten) && std::ferror(stdout))
      return failToPrint(ranks); // thrown by fmt
    return fail(ranks, failure.kind, support::textOf(failure, support::shellLine({argv, argv + argc})));
  }
}

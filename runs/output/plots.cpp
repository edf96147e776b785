// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/plots.hpp"

#include "runs/support/locations.hpp"
#include "runs/support/print_stderr.hpp"
#include "runs/support/program_call.hpp"

#include <fmt/format.h>

namespace grouser::output {

namespace {

// Python of Debian, with the packages python3-matplotlib and python3-h5py; the PATH may begin with another Python.
constexpr const char* kPython = "/usr/bin/python3";

/// Runs a script of runs/plots/. Returns false and sets `warning` on failure.
bool draw(const std::string& name, const std::vector<std::string>& arguments, std::string& warning) {
  const std::filesystem::path script = support::shareFolder() / "runs" / "plots" / name;
  warning.clear();
  if (!std::filesystem::exists(script)) {
    warning = fmt::format("no plots: {} is missing; set GROUSER_SHARE to the folder that contains runs/plots",
                          script.string());
    return false;
  }
  const support::CallOutcome outcome = callPython(script, arguments);
  if (!outcome.started)
    warning = fmt::format("no plots: {}; install python3, python3-matplotlib and python3-h5py", outcome.output);
  else if (outcome.status != 0)
    warning = fmt::format("no plots: {}", outcome.status == kMissingPackage
                                              ? support::lastLine(outcome.output)
                                              : script.string() + ": " + support::lastLine(outcome.output));
  return outcome.status == 0;
}

} // namespace

std::vector<std::filesystem::path> drawPlots(const std::filesystem::path& results, const std::filesystem::path& folder,
                                             const std::vector<std::string>& names, std::string& warning) {
  std::vector<std::string> words = {results.string(), folder.string()};
  words.insert(words.end(), names.begin(), names.end());
  std::vector<std::filesystem::path> drawn;
  if (!draw("plot.py", words, warning)) return drawn;
  for (const std::string& name : names)
    if (const auto file = folder / (name + ".png"); std::filesystem::exists(file)) drawn.push_back(file);
  return drawn;
}

void drawPicture(const std::string& script, const std::vector<std::filesystem::path>& inputs,
                 const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) std::filesystem::remove(file, error);
  std::vector<std::string> words;
  for (const std::filesystem::path& input : inputs) words.push_back(input.string());
  words.push_back(file.string());
  std::string warning;
  if (!draw(script, words, warning))
    support::printStderr("WARNING: {}\n", warning);
  else if (std::filesystem::exists(file, error))
    fmt::print("plot      {}\n", file.string());
}

support::CallOutcome callPython(const std::filesystem::path& script, const std::vector<std::string>& words) {
  std::vector<std::string> all = {kPython, script.string()};
  all.insert(all.end(), words.begin(), words.end());
  return support::callProgram(all);
}

bool runScript(const std::filesystem::path& script, const std::vector<std::string>& arguments, std::string& warning) {
  const support::CallOutcome outcome = callPython(script, arguments);
  if (outcome.status != 0)
    warning = fmt::format("{} {}: {}", kPython, script.string(), support::lastLine(outcome.output));
  return outcome.status == 0;
}

} // namespace grouser::output

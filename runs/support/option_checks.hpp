// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <limits>
#include <string>

/// What the words of the command line may be, said in one line: "--steps: -1 is not a whole number of at least 1".
namespace grouser::support {

/// A whole number in [low, high].
CLI::Validator wholeNumber(std::int64_t low, std::int64_t high = std::numeric_limits<std::int64_t>::max());

/// A finite number above 0; `what` names it and its unit: "a length in metres".
CLI::Validator positive(const std::string& what);

/// For transform(): "10%" and "10 %" are 10.
CLI::Validator percentSign();

/// A finite number of at least 0.
CLI::Validator notNegative(const std::string& what);

/// A finite number in [low, high].
CLI::Validator between(double low, double high);

/// Of an option that names a file of a run, for transform(): in the place of a folder the file of this name in it.
CLI::Validator orItsFolder(const std::string& file);

/// Checks that the file named by an option can be written, before any work.
CLI::Validator writableFile(const std::string& option);

/// An option that takes one of the words of an enum; help shows its default.
template <base::HasWords E>
CLI::Option* addChoice(CLI::App& app, const std::string& name, E& choice, const std::string& help) {
  const auto take = [&choice](const std::string& word) { choice = *base::valueOf<E>(word); };
  return app.add_option_function<std::string>(name, take, help)
      ->check(CLI::IsMember(base::wordsOf<E>()))
      ->default_str(std::string(base::wordOf(choice)));
}

/// Where results go, by the same two names in every command.
CLI::Option* addOut(CLI::App& app, std::string& place, const std::string& help);

/// The message for a first word, or one after a command of commands, that is no command: it names the nearest. Empty
/// where there is none such.
std::string unknownCommand(const CLI::App& app, int argc, const char* const* argv);

/// Hint for the first word that begins with "--" and is no option of its command: "; did you mean --threads?". Empty
/// without such a word or a similar option.
std::string nearestOptionHint(const CLI::App& app, int argc, const char* const* argv);

/// Has every option of the commands below `app` refuse the name of another option as its value: that value was
/// forgotten.
void refuseOptionsAsValues(CLI::App& app);

} // namespace grouser::support

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <limits>
#include <string>

/// Checks of option values, with one-line messages: "--steps: -1 is not a whole number of at least 1".
namespace grouser::support {

/// A whole number in [low, high].
CLI::Validator wholeNumber(std::int64_t low, std::int64_t high = std::numeric_limits<std::int64_t>::max());

/// A finite number above 0; `what` names it and its unit: "a length in metres".
CLI::Validator positive(const std::string& what);

/// For transform(): converts "10%" and "10 %" to 10.
CLI::Validator percentSign();

/// A finite number of at least 0.
CLI::Validator notNegative(const std::string& what);

/// A finite number in [low, high].
CLI::Validator between(double low, double high);

/// For transform() of an option that names a file of a run: replaces a folder by the path of `file` in it.
CLI::Validator orItsFolder(const std::string& file);

/// Checks that the file named by an option can be written, before any work.
CLI::Validator writableFile(const std::string& option);

/// Adds an option that accepts one of the words of an enum; help shows the default.
template <base::HasWords E>
CLI::Option* addChoice(CLI::App& app, const std::string& name, E& choice, const std::string& help) {
  const auto take = [&choice](const std::string& word) { choice = *base::valueOf<E>(word); };
  return app.add_option_function<std::string>(name, take, help)
      ->check(CLI::IsMember(base::wordsOf<E>()))
      ->default_str(std::string(base::wordOf(choice)));
}

/// Adds the output option, with the same two names in every command.
CLI::Option* addOut(CLI::App& app, std::string& place, const std::string& help);

/// Error message for an unknown command or subcommand, with the nearest name. Empty if all are known.
std::string unknownCommand(const CLI::App& app, int argc, const char* const* argv);

/// Hint for the first word that begins with "--" but is not an option of its command: the other commands with this
/// option, or "; did you mean --threads?". Empty if there is no such word or no similar option.
std::string nearestOptionHint(const CLI::App& app, int argc, const char* const* argv);

/// Makes all options of `app` and its subcommands reject the name of another option as value: then the value is
/// missing.
void refuseOptionsAsValues(CLI::App& app);

} // namespace grouser::support

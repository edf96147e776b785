// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// The manual and the shell's completion, from the tables that `--help` is made of.
namespace grouser::commands {

/// Prints `--help` in the words of the manual.
std::shared_ptr<CLI::Formatter> helpFormatter();

/// A page of section 1, as man(7) reads it. `command`: of `app`'s commands; null: the page of the program itself.
std::string manualPage(const CLI::App& app, const CLI::App* command);

/// docs/options.md: every command with its words and options.
std::string optionsDocument(const CLI::App& app);

/// Completion for bash: commands, options, and the words that an option takes; files elsewhere.
std::string bashCompletion(const CLI::App& app);

/// Writes all pages to folder/man/man1 and the completion to folder/bash-completion/completions. Throws
/// support::NotWritten where a file cannot be written.
void writeManual(const CLI::App& app, const std::filesystem::path& folder);

/// The words that an option takes, where there is a list of them.
std::vector<std::string> choicesOf(const CLI::Option& option);

} // namespace grouser::commands

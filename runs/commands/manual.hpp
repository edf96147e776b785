// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// Manual and shell completion, generated from the options of the command line.
namespace grouser::commands {

/// Formats the text of `--help` like the manual.
std::shared_ptr<CLI::Formatter> helpFormatter();

/// A manual page of section 1 in man(7) format. `command`: a command of `app`; null: the page of the program.
std::string manualPage(const CLI::App& app, const CLI::App* command);

/// docs/options.md: every command with its arguments and options.
std::string optionsDocument(const CLI::App& app);

/// Completion script for bash: completes commands, options, values of options, and otherwise file names.
std::string bashCompletion(const CLI::App& app);

/// Writes all pages to folder/man/man1 and the completion script to folder/bash-completion/completions. Throws
/// support::NotWritten if a file cannot be written.
void writeManual(const CLI::App& app, const std::filesystem::path& folder);

/// Allowed values of an option; empty if the option has no list of values.
std::vector<std::string> choicesOf(const CLI::Option& option);

} // namespace grouser::commands
